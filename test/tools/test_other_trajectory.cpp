// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "test/tools/tool_run.hpp"
#include "tools/eval/drive/other_trajectory.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

std::string write(const TemporaryFolder& folder, const std::string& name, const std::string& text) {
  std::ofstream(folder.file(name)) << text;
  return folder.file(name);
}

/// A quarter of a left turn on a circle of 10 m in 20 steps of 0.1 s, of which all are `scale` too
/// long, begun elsewhere, looking elsewhere.
struct Turn {
  static constexpr int kSteps = 20;
  static double yaw_rad(int step) { return step * M_PI / 2.0 / kSteps; }
  static double x_m(int step) { return 10.0 * std::sin(yaw_rad(step)); }
  static double y_m(int step) { return 10.0 * (1.0 - std::cos(yaw_rad(step))); }
};

std::string tum(double scale, int first_missing = Turn::kSteps, int count = 0) {
  std::ostringstream text;
  text << "# time x y z qx qy qz qw\n";
  text.precision(12);
  for (int i = 0; i <= Turn::kSteps; ++i) {
    if (i >= first_missing && i < first_missing + count) {
      continue;
    }
    const double yaw_rad = Turn::yaw_rad(i) + 1.0;
    const double x = scale * (std::cos(1.0) * Turn::x_m(i) - std::sin(1.0) * Turn::y_m(i)) - 7.0;
    const double y = scale * (std::sin(1.0) * Turn::x_m(i) + std::cos(1.0) * Turn::y_m(i)) + 3.0;
    text << 1000.0 + 0.1 * i << ' ' << x << ' ' << y << " 0.5 0 0 " << std::sin(yaw_rad / 2) << ' '
         << std::cos(yaw_rad / 2) << '\n';
  }
  return text.str();
}

/// The camera looks ahead: its z is forward, its x right.
std::string kitti() {
  std::ostringstream text;
  text.precision(12);
  for (int i = 0; i <= Turn::kSteps; ++i) {
    const double c = std::cos(Turn::yaw_rad(i));
    const double s = std::sin(Turn::yaw_rad(i));
    text << c << " 0 " << -s << ' ' << -Turn::y_m(i) << " 0 1 0 0 " << s << " 0 " << c << ' '
         << Turn::x_m(i) << '\n';
  }
  return text.str();
}

std::string times() {
  std::ostringstream text;
  for (int i = 0; i <= Turn::kSteps; ++i) {
    text << 1000.0 + 0.1 * i << '\n';
  }
  return text.str();
}

std::string write_truth(const TemporaryFolder& folder) {
  std::ostringstream text;
  text.precision(12);
  text << "utime,x_m,y_m,yaw_rad\n";
  for (int i = 0; i <= Turn::kSteps; ++i) {
    text << 1'000'000'000 + 100'000 * i << ',' << Turn::x_m(i) << ',' << Turn::y_m(i) << ','
         << Turn::yaw_rad(i) << '\n';
  }
  return write(folder, "truth.csv", text.str());
}

std::string write_odometry(const TemporaryFolder& folder) {
  std::ostringstream text;
  text << "utime_start,utime,source,x_m,y_m,yaw_rad,cov_xx,cov_xy,cov_xyaw,cov_yy,cov_yyaw,"
          "cov_yawyaw,status,targets,iterations,solve_us\n";
  for (int i = 0; i < Turn::kSteps; ++i) {
    text << 1'000'000'000 + 100'000 * i << ',' << 1'000'100'000 + 100'000 * i
         << ",front,0.79,0,0.0785,1e-4,0,0,0,0,1e-6,ok,50,5,0\n";
  }
  return write(folder, "odometry.csv", text.str());
}

constexpr TimeSpan kDrive{1'000'000'000, 1'002'000'000};

}  // namespace

TEST_CASE("A trajectory in TUM format and one of a camera in KITTI's are the same motions") {
  const TemporaryFolder folder;
  const auto of_tum = read_other_trajectory(write(folder, "lidar.tum", tum(1.0)), kDrive);
  const auto of_kitti = read_other_trajectory(
      write(folder, "camera.txt", kitti()) + "," + write(folder, "times.txt", times()), kDrive);
  CHECK(of_tum.source == "lidar");
  CHECK(of_kitti.source == "camera");
  REQUIRE(of_tum.estimates.size() == Turn::kSteps);
  REQUIRE(of_kitti.estimates.size() == Turn::kSteps);
  const double step_rad = Turn::yaw_rad(1);
  for (int i = 0; i < Turn::kSteps; ++i) {
    const auto index = static_cast<std::size_t>(i);
    for (const RecordedEstimate& step : {of_tum.estimates[index], of_kitti.estimates[index]}) {
      CHECK(step.start_us == 1'000'000'000 + 100'000 * i);
      CHECK(step.end_us == step.start_us + 100'000);
      CHECK(step.motion.x() == Approx(Turn::x_m(1)));
      CHECK(step.motion.y() == Approx(Turn::y_m(1)));
      CHECK(step.motion.z() == Approx(step_rad));
      CHECK(std::isnan(step.covariance(0, 0)));
    }
  }
}

TEST_CASE("cremed-eval drive shows other systems in the same tables, wherever they began") {
  const TemporaryFolder folder;
  const std::string drive = "drive " + write_odometry(folder) + " " + write_truth(folder);
  const std::string others = " --other " + write(folder, "lidar.tum", tum(1.02)) + " --other " +
                             write(folder, "camera.txt", kitti()) + "," +
                             write(folder, "times.txt", times());
  const ToolRun json = run_tool("cremed-eval", folder, drive + others + " --json");
  CAPTURE(json.error);
  REQUIRE(json.status == 0);
  const auto sources = nlohmann::json::parse(json.output)["sources"];
  REQUIRE(sources.size() == 3);
  CHECK(sources[0]["source"] == "front");
  CHECK(sources[0]["anees"].is_number());
  CHECK(sources[1]["source"] == "lidar");
  CHECK(sources[1]["rmse_m"].get<double>() == Approx(0.02 * 2.0 * 10.0 * std::sin(M_PI / 80.0)));
  CHECK(sources[1]["rmse_deg"].get<double>() < 1e-6);
  CHECK(sources[1]["mean_drift"]["translation_percent"].get<double>() == Approx(2.0).epsilon(0.1));
  CHECK(sources[1]["anees"].is_null());
  CHECK(sources[1]["coverage_x"][0].is_null());
  CHECK(sources[2]["source"] == "camera");
  CHECK(sources[2]["rmse_m"].get<double>() < 1e-6);
  const ToolRun tables = run_tool("cremed-eval", folder, drive + others);
  CHECK_THAT(tables.output, Catch::Contains("\nlidar "));
  const ToolRun picture =
      run_tool("cremed-eval", folder, drive + others + " --plot " + folder.file("picture.png"));
  CAPTURE(picture.error);
  CHECK(picture.status == 0);
}

TEST_CASE("What another system did in a gap is not known, and the gap is told") {
  const TemporaryFolder folder;
  const std::string file = write(folder, "lidar.tum", tum(1.0, 6, 7));
  const RecordedOdometry lidar = read_other_trajectory(file, kDrive);
  CHECK(lidar.estimates.size() == Turn::kSteps - 8);
  CHECK(lidar.availability.percent == Approx(60.0));
  // Of the drive: it ends half a second before, or goes on for longer.
  CHECK(read_other_trajectory(file, {kDrive.begin_us, kDrive.end_us + 500'000})
            .availability.percent == Approx(48.0));
  CHECK(read_other_trajectory(file, {kDrive.begin_us, kDrive.end_us - 1'000'000})
            .availability.percent == Approx(50.0));
  const ToolRun run =
      run_tool("cremed-eval", folder,
               "drive " + write_odometry(folder) + " " + write_truth(folder) + " --other " + file);
  CAPTURE(run.error);
  CHECK(run.status == 0);
  CHECK_THAT(run.output, Catch::Contains("lidar           a usable estimate for 60.0 %"));
  CHECK_THAT(run.error, Catch::Contains("lidar: 0 rows without estimate, 0 estimates outside of "
                                        "truth's time, nothing from 0.5 s to 1.3 s\n"));
}

TEST_CASE("A trajectory that cannot be read is told with its line") {
  const TemporaryFolder folder;
  const std::string drive = "drive " + write_odometry(folder) + " " + write_truth(folder);
  const auto refused = [&](const std::string& text, const std::string& told) {
    const ToolRun run =
        run_tool("cremed-eval", folder, drive + " --other " + write(folder, "other", text));
    check(run, {"", 1, told});
  };
  refused("1 2 3\n", "line 1: 3 numbers where 8 are expected");
  refused("# no pose\n\n1 0 0 0 0 0 0 one\n", "line 3: 'one' is no number");
  refused("1 nan 0 0 0 0 0 1\n", "line 1: 'nan' is no number");
  refused("1000 0 0 0 0 0 0 1\n", "fewer than two poses");
  refused("1000 0 0 0 0 0 0 1\n1000 1 0 0 0 0 0 1\n", "pose 2: its time is not later");
  refused(
      "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n",
      "no pose within truth's time: it is utime 1000000 to 2000000, truth's utime 1000000000 to");
  refused("1e15 0 0 0 0 0 0 1\n", "is no time in seconds");
  check(run_tool("cremed-eval", folder,
                 drive + " --other " + write(folder, "camera", kitti()) + "," +
                     write(folder, "times", "1\n2\n")),
        {"", 1, "2 times for 21 poses"});
  check(run_tool("cremed-eval", folder, drive + " --other missing"),
        {"", 1, "cannot read missing"});
}
