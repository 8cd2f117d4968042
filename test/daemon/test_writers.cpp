// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "daemon/output/csv_writer.hpp"
#include "daemon/output/odometry_writer.hpp"
#include "daemon/output/tum_writer.hpp"
#include "test/daemon/temporary_file.hpp"

using namespace cremed;

namespace {

EgoMotion estimate(std::int64_t start_us, std::int64_t end_us, double x_m, double yaw_rad) {
  EgoMotion motion;
  motion.utime_start_us = start_us;
  motion.utime_us = end_us;
  motion.status = MotionStatus::ok;
  motion.motion << x_m, 0.0, yaw_rad;
  motion.covariance << 1e-4, 0.0, 2e-6, 0.0, 0.0, 0.0, 2e-6, 0.0, 4e-6;
  motion.targets = 57;
  motion.iterations = 6;
  return motion;
}

Odometry state(std::int64_t before_us, std::int64_t utime_us, double odom_x_m) {
  Odometry odometry;
  odometry.utime_before_us = before_us;
  odometry.utime_us = utime_us;
  odometry.odom_pose.x() = odom_x_m;
  return odometry;
}

std::vector<std::string> lines(const std::string& text) {
  std::istringstream input(text);
  std::vector<std::string> result;
  for (std::string line; std::getline(input, line);) {
    result.push_back(line);
  }
  return result;
}

}  // namespace

TEST_CASE("CSV: the columns of the design, a row a motion") {
  const TemporaryFile file;
  CsvWriter writer(file.path(), {"front", "rear"});
  writer.on_motion(1, estimate(1'000'000, 1'075'000, 0.5, 0.25), 321);
  EgoMotion nothing;
  nothing.utime_start_us = nothing.utime_us = 2'000'000;
  nothing.status = MotionStatus::too_few_targets;
  nothing.targets = 2;
  writer.on_motion(0, nothing, 0);

  const auto rows = lines(file.content());
  REQUIRE(rows.size() == 3);
  CHECK(
      rows[0] ==
      "utime_start,utime,source,x_m,y_m,yaw_rad,cov_xx,cov_xy,cov_xyaw,cov_yy,cov_yyaw,cov_yawyaw,"
      "status,targets,iterations,solve_us");
  CHECK(rows[1] ==
        "1000000,1075000,rear,0.500000000,0.000000000,0.250000000,1.000000000e-04,0.000000000e+00,"
        "2.000000000e-06,0.000000000e+00,0.000000000e+00,4.000000000e-06,ok,57,6,321");
  CHECK(rows[2] ==
        "2000000,2000000,front,nan,nan,nan,nan,nan,nan,nan,nan,nan,too_few_targets,2,0,0");
}

TEST_CASE("CSV: a file that cannot be made is an error; one that cannot be written is counted") {
  CHECK_THROWS_WITH(CsvWriter("/nonexistent/odo.csv", {"a"}), Catch::Contains("/nonexistent/odo"));
  CsvWriter full("/dev/full", {"front"});
  full.on_motion(0, estimate(0, 1, 0.0, 0.0), 0);
  CHECK(full.failures() == 2);  // header and row
}

TEST_CASE("TUM: four quarter turns on a square come back to the start") {
  const TemporaryFile file;
  TumWriter writer(file.path(), 0);
  for (int i = 0; i < 4; ++i) {
    writer.on_motion(0, estimate(i * 1'000'000, (i + 1) * 1'000'000, 2.0, std::numbers::pi / 2), 0);
  }
  const auto rows = lines(file.content());
  REQUIRE(rows.size() == 5);
  CHECK(rows[0] == "0.000000 0.000000 0.000000 0 0 0 0.000000000 1.000000000");
  CHECK(rows[1] == "1.000000 2.000000 0.000000 0 0 0 0.707106781 0.707106781");
  double time_s = 0.0;
  double x_m = 1.0;
  double y_m = 1.0;
  std::istringstream(rows[4]) >> time_s >> x_m >> y_m;
  CHECK(time_s == 4.0);
  CHECK(x_m == Approx(0.0).margin(1e-6));
  CHECK(y_m == Approx(0.0).margin(1e-6));
}

TEST_CASE("TUM: other radars and rows without estimate are left out, gaps counted") {
  const TemporaryFile file;
  TumWriter writer(file.path(), 1);
  writer.on_motion(0, estimate(0, 100, 9.0, 0.0), 0);
  writer.on_motion(1, estimate(100, 200, 1.0, 0.0), 0);
  EgoMotion nothing;
  nothing.status = MotionStatus::incomplete_scan;
  writer.on_motion(1, nothing, 0);
  CHECK(writer.gaps() == 0);
  writer.on_motion(1, estimate(200, 300, 1.0, 0.0), 0);  // spans the bad scan: no gap
  CHECK(writer.gaps() == 0);
  writer.on_motion(1, estimate(900, 1000, 1.0, 0.0), 0);
  CHECK(writer.gaps() == 1);
  CHECK(lines(file.content()).size() == 4);
}

TEST_CASE("CSV: the motion of all radars is named fused") {
  const TemporaryFile file;
  CsvWriter writer(file.path(), {"front", "rear"});
  writer.on_fused(estimate(1'000'000, 1'075'000, 0.5, 0.25), 9);
  const auto rows = lines(file.content());
  REQUIRE(rows.size() == 2);
  CHECK_THAT(rows[1], Catch::StartsWith("1000000,1075000,fused,0.500000000,"));
  CHECK_THAT(rows[1], Catch::EndsWith(",ok,57,6,9"));
}

TEST_CASE("TUM: follows the odometry if no radar is named, and only then") {
  struct Row {
    std::optional<std::size_t> radar;
    const char* last;
  };
  for (const Row& row : {Row{0, "2.000000 3.000000 "}, Row{std::nullopt, "2.000000 7.000000 "}}) {
    const TemporaryFile file;
    TumWriter writer(file.path(), row.radar);
    for (std::int64_t i = 0; i < 2; ++i) {
      writer.on_motion(0, estimate(i * 1'000'000, (i + 1) * 1'000'000, 1.5, 0.0), 0);
      writer.on_odometry(
          state(i * 1'000'000, (i + 1) * 1'000'000, 3.5 * static_cast<double>(i + 1)));
    }
    const auto rows = lines(file.content());
    REQUIRE(rows.size() == 3);
    CHECK_THAT(rows[2], Catch::StartsWith(row.last));
    CHECK(writer.gaps() == 0);
    writer.on_odometry(state(5'000'000, 6'000'000, 8.0));
    CHECK(writer.gaps() == (row.radar ? 0 : 1));
  }
}

TEST_CASE("Odometry CSV: the columns of the design, a row an output") {
  const TemporaryFile file;
  OdometryWriter writer(file.path());
  Odometry odometry = state(1'000'000, 1'075'000, 4.0);
  odometry.utime_anchor_us = 500'000;
  odometry.status = OdometryStatus::standing_still;
  odometry.pose << 0.5, 0.25, -0.125;
  odometry.covariance << 1, 2, 3, 2, 5, 6, 3, 6, 9;
  odometry.twist << 7.0, 8.0, 9.0;
  odometry.twist_covariance << 21, 22, 23, 22, 25, 26, 23, 26, 29;
  writer.on_odometry(odometry);
  writer.on_motion(0, estimate(0, 1, 0.0, 0.0), 0);
  writer.on_fused(estimate(0, 1, 0.0, 0.0), 0);
  const auto rows = lines(file.content());
  REQUIRE(rows.size() == 2);
  CHECK(rows[0] ==
        "utime,utime_anchor,status,x_m,y_m,yaw_rad,cov_xx,cov_xy,cov_xyaw,cov_yy,cov_yyaw,"
        "cov_yawyaw,odom_x_m,odom_y_m,odom_yaw_rad,vx_mps,vy_mps,yaw_rate_radps,"
        "cov_vxvx,cov_vxvy,cov_vxw,cov_vyvy,cov_vyw,cov_ww");
  CHECK(rows[1] ==
        "1075000,500000,standing_still,0.500000000,0.250000000,-0.125000000,"
        "1.000000000e+00,2.000000000e+00,3.000000000e+00,5.000000000e+00,6.000000000e+00,"
        "9.000000000e+00,4.000000000,0.000000000,0.000000000,7.000000000,8.000000000,9.000000000,"
        "2.100000000e+01,2.200000000e+01,2.300000000e+01,2.500000000e+01,2.600000000e+01,"
        "2.900000000e+01");
  CHECK_THROWS_WITH(OdometryWriter("/nonexistent/o.csv"), Catch::Contains("/nonexistent/o.csv"));
}
