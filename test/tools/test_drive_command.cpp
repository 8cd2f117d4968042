// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "test/tools/tool_run.hpp"

using namespace cremed::test;
using cremed::TemporaryFolder;

namespace {

ToolRun run_eval(const TemporaryFolder& folder, const std::string& arguments) {
  return run_tool("cremed-eval", folder, arguments);
}

/// Odometry of these sources, 20 m straight on at 10 m/s with a scale error of 1 %, and its truth.
std::string write_drive(const TemporaryFolder& folder, const std::vector<std::string>& sources) {
  std::ofstream truth(folder.file("truth.csv"));
  truth << "utime,x_m,y_m,yaw_rad\n1000000,50,60,0\n3000000,70,60,0\n";
  std::ofstream odometry(folder.file("odometry.csv"));
  odometry << "utime_start,utime,source,x_m,y_m,yaw_rad,cov_xx,cov_xy,cov_xyaw,cov_yy,cov_yyaw,"
              "cov_yawyaw,status,targets,iterations,solve_us\n";
  for (const std::string& source : sources) {
    const char* const variance_y = source == "sideways" ? "1e-4" : "0";
    odometry << "1000000,1000000," << source << ",nan,nan,nan,nan,nan,nan,nan,nan,nan,"
             << (source == "blind" ? "too_few_targets" : "no_reference") << ",9,0,0\n";
    for (int step = 0; step < 20 && source != "blind"; ++step) {
      odometry << 1'000'000 + 100'000 * step << ',' << 1'100'000 + 100'000 * step << ',' << source
               << ",1.01,0,0,1e-4,0,0," << variance_y << ",0,1e-6,ok,50,5,0\n";
    }
  }
  return "drive " + folder.file("odometry.csv") + " " + folder.file("truth.csv");
}

/// Wheels of that drive, exact.
std::string write_wheels(const TemporaryFolder& folder) {
  std::ofstream wheels(folder.file("wheels.csv"));
  wheels << "utime,speed_mps,yaw_rate_radps\n1000000,10,0\n3000000,10,0\n";
  return " --wheels " + folder.file("wheels.csv");
}

/// The same drive as the vehicle's state relative to two anchors, 2 % too long and 0.2 m/s too
/// fast.
std::string write_states(const TemporaryFolder& folder) {
  std::ofstream states(folder.file("states.csv"));
  states << "utime,utime_anchor,status,x_m,y_m,yaw_rad,cov_xx,cov_xy,cov_xyaw,cov_yy,cov_yyaw,"
            "cov_yawyaw,odom_x_m,odom_y_m,odom_yaw_rad,vx_mps,vy_mps,yaw_rate_radps,cov_vxvx,"
            "cov_vxvy,cov_vxw,cov_vyvy,cov_vyw,cov_ww\n";
  for (int step = 0; step <= 20; ++step) {
    const int anchor = step <= 10 ? 0 : 10;
    const double way_m = 1.02 * (step - anchor);
    states << 1'000'000 + 100'000 * step << ',' << 1'000'000 + 100'000 * anchor << ",ok," << way_m
           << ",0,0,0.04,0,0,0.01,0,1e-6," << 1.02 * step << ",0,0,10.2,0,0,0.01,0,0,0.01,0,1e-4\n";
  }
  return "drive " + folder.file("states.csv") + " " + folder.file("truth.csv");
}

/// Words of the first comment with that beginning.
std::vector<std::string> words(const std::string& output, const std::string& begin) {
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    if (line.find("# " + begin) == 0) {
      std::istringstream cells(line.substr(2 + begin.size()));
      return {std::istream_iterator<std::string>(cells), {}};
    }
  }
  return {};
}

}  // namespace

TEST_CASE("cremed-eval drive prints a line a source; drift over distance stands in comments") {
  const TemporaryFolder folder;
  const ToolRun result = run_eval(folder, write_drive(folder, {"front", "sideways"}));
  REQUIRE(result.status == 0);
  const auto rows = cells(result.output);
  REQUIRE(rows.size() == 2);
  CHECK(rows[0][0] == "front");
  CHECK(rows[0][1] == "20");
  CHECK(rows[0][2] == "0.01000");
  CHECK(rows[0][4] == "0.5000");
  CHECK(rows[1][4] == "0.3333");
  const auto starts_with = [&](const char* row, const std::vector<std::string>& first) {
    std::vector<std::string> drift = words(result.output, row);
    REQUIRE(drift.size() == 11);
    drift.resize(first.size());
    CHECK(drift == first);
  };
  starts_with("front           %", {"1.00", "-", "-"});
  starts_with("front           deg/m", {"0.0000", "-", "-"});
  starts_with("front           segments", {"10", "0", "0"});
}

TEST_CASE("cremed-eval drive tells how true the motions are when they are chained") {
  const TemporaryFolder folder;
  const ToolRun result = run_eval(folder, write_drive(folder, {"sideways"}));
  REQUIRE(result.status == 0);
  // 1 % of the path, chained: 10 motions of 0.01 m each, their sigma of 0.01 m added as
  // independent. From 0.5 s on, a chain and a window every 0.5 s.
  CHECK(words(result.output, "sideways          10 m ") ==
        std::vector<std::string>{"2", "0.100", "0.000", "0.000", "0.99", "2", "3.33", "10.00",
                                 "0.00", "0.00"});
  CHECK(words(result.output, "sideways           1 s ") ==
        std::vector<std::string>{"2", "0.100", "0.000", "0.000", "1.00", "2", "3.33", "10.00",
                                 "0.00", "0.00"});
  CHECK(words(result.output, "sideways          50 m ").empty());
}

TEST_CASE("cremed-eval drive compares with the wheels and splits NEES") {
  const TemporaryFolder folder;
  const std::string drive = write_drive(folder, {"front"});
  const ToolRun result = run_eval(folder, drive + write_wheels(folder));
  CAPTURE(result.error);
  REQUIRE(result.status == 0);
  const std::vector<std::string> x = words(result.output, "front           x m/s ");
  CHECK(x == std::vector<std::string>{"20", "1.000", "1.000", "0.000", "0.000", "1.000", "0.1000",
                                      "0.0000", "0.1000"});
  const ToolRun doubted = run_eval(folder, drive + write_wheels(folder) + " --wheels-std 0.1,0");
  CHECK(words(doubted.output, "front           x m/s ")[1] == "0.500");
  CHECK(doubted.output.find("their std 0.1 m/s, 0 rad/s") != std::string::npos);
}

TEST_CASE("cremed-eval drive adds truth's own noise and says so in each table it changes") {
  const TemporaryFolder folder;
  const std::string drive = write_drive(folder, {"sideways"});
  const auto anees = [&](const std::string& options) {
    return cells(run_eval(folder, drive + options).output)[0][4];
  };
  CHECK(anees("") == "0.3333");
  CHECK(anees(" --truth-std 0.01,0") == "0.1667");
  CHECK(anees(" --truth-std 0.01,0.5,0,0.1 --truth-std 3,3,3,20") == "0.1667");
  const std::string output = run_eval(folder, drive + " --truth-std 0.01,0").output;
  const std::string note = "truth's own std added to the covariance: 0.01, 0.01 m, 0 rad";
  CHECK(output.find(note) < output.find("\nsideways"));
  CHECK(output.find(note, output.find("pose after")) != std::string::npos);
}

TEST_CASE("cremed-eval drive knows the vehicle's state by its header") {
  const TemporaryFolder folder;
  write_drive(folder, {"front"});
  const ToolRun result = run_eval(folder, write_states(folder) + write_wheels(folder));
  CAPTURE(result.error);
  REQUIRE(result.status == 0);
  const auto rows = cells(result.output);
  REQUIRE(rows.size() == 1);
  CHECK(rows[0][0] == "odometry");
  CHECK(rows[0][1] == "20");
  // Chained over the anchor: 0.4 m error at a variance of 0.08 m^2, drift 2 %.
  CHECK(words(result.output, "odometry        %")[0] == "2.00");
  CHECK(words(result.output, "odometry          10 m ") ==
        std::vector<std::string>{"2", "0.200", "0.000", "0.000", "1.96", "2", "0.33", "1.00",
                                 "0.00", "0.00"});
  // Two windows of the poses since the start, each 0.2 m too long, and two chains.
  CHECK(words(result.output, "odometry           1 s ") ==
        std::vector<std::string>{"2", "0.200", "0.000", "0.000", "2.00", "2", "0.33", "1.00",
                                 "0.00", "0.00"});
  CHECK_THAT(result.output, Catch::Contains("every window, begun 0.5 s apart") &&
                                Catch::Contains("from every anchor"));
  CHECK(words(result.output, "odometry        vx m/s ") ==
        std::vector<std::string>{"21", "4.000", "0.2000"});
  CHECK(words(result.output, "odometry        w deg/s")[1] == "0.000");
}

TEST_CASE("cremed-eval drive --json says the same to scripts") {
  const TemporaryFolder folder;
  const std::string drive = write_drive(folder, {"front", "blind"});
  const std::string options =
      write_wheels(folder) + " --wheels-std 0,0.1 --truth-std 0.01,0.02,0.3,1";
  const auto json = nlohmann::json::parse(run_eval(folder, drive + options + " --json").output);
  const std::string text = run_eval(folder, drive + options).output;
  const auto& front = json["sources"][0];
  CHECK(front["source"] == "front");
  CHECK(front["n"] == 20);
  CHECK(front["rmse_m"].get<double>() == Approx(0.01));
  CHECK(front["anees"].get<double>() == Approx(std::stod(cells(text)[0][4])).epsilon(1e-3));
  CHECK(front["coverage_y"][0].is_null());
  CHECK(front["segments"][0]["after"] == "10 m");
  CHECK(front["segments"][0]["rmse_m_m_rad"][0].get<double>() == Approx(0.1));
  CHECK(front["segments"][3]["segments"] == 2);
  CHECK(front["segments"][3]["chains"] == 2);
  CHECK(front["segments"][6]["anees"].is_null());
  CHECK(front["wheels"]["x"]["nees"].get<double>() == Approx(1.0));
  CHECK_FALSE(front.contains("twist"));
  CHECK(json["sources"][1]["without_estimate"] == 1);
  CHECK(json["truth_std"][0]["y_m"] == 0.02);
  CHECK(json["wheels_std"]["yaw_rate_radps"] == 0.1);
  CHECK(json["truth_against_wheels"][0]["intervals"] == 193);
  const auto states = nlohmann::json::parse(
      run_eval(folder, write_states(folder) + write_wheels(folder) + " --json").output);
  CHECK(states["sources"][0]["twist"]["nees_speed"].get<double>() == Approx(4.0));
}

TEST_CASE("cremed-eval drive draws one source and many, without an estimate too") {
  const TemporaryFolder folder;
  const auto sources = GENERATE(
      std::vector<std::string>{"front"}, std::vector<std::string>{"blind"},
      std::vector<std::string>{"a", "b", "blind", "sideways", "d", "e", "f", "g", "h", "fused"});
  const std::string picture = folder.file("picture.svg");
  const ToolRun result = run_eval(folder, write_drive(folder, sources) + " --plot " + picture);
  CAPTURE(sources.size(), result.error);
  const bool has_estimates = sources.front() != "blind";
  CHECK(result.status == (has_estimates ? 0 : 1));
  CHECK(result.error.find("Warning") == std::string::npos);
  const std::string svg = content(picture);
  CHECK(svg.find("</svg>") != std::string::npos);
  // Matplotlib writes each text into a comment.
  CHECK((svg.find("error of x [m], 0.0 % outside 3 sigma") != std::string::npos) == has_estimates);
  CHECK((svg.find("ANEES 0.50 (95 % band") != std::string::npos) == has_estimates);
  CHECK((svg.find("drift 1.00 %, 0.0000 deg/m") != std::string::npos) == has_estimates);
}

TEST_CASE("cremed-eval drive writes what it draws as tables, never over an input") {
  const TemporaryFolder folder;
  const std::string drive = write_drive(folder, {"front"});
  REQUIRE(run_eval(folder, drive + " --tables " + folder.file("")).status == 0);
  CHECK(content(folder.file("sources.csv")).starts_with("source,dof,estimates,"));
  // A drive of 2 s has no window of 10 s.
  CHECK_THAT(content(folder.file("sources.csv")),
             Catch::Contains(",windows_10s,yaw_deg_10s,percent_10s,anees_10s\n") &&
                 Catch::EndsWith(",0,nan,nan,nan\n"));
  CHECK(content(folder.file("errors.csv")).find("\nfront,") != std::string::npos);
  CHECK(content(folder.file("true_path.csv")).starts_with("x_m,y_m\n0.0000,0.0000\n"));
  for (const char* name : {"path.csv", "drift.csv"}) {
    CHECK(std::filesystem::file_size(folder.file(name)) > 0);
  }
  CHECK(run_eval(folder, drive + " --tables /no/such/folder").status == 1);
  const ToolRun refused =
      run_eval(folder, "drive " + folder.file("path.csv") + " " + folder.file("truth.csv") +
                           " --tables " + folder.file(""));
  CHECK(refused.status == 2);
  CHECK(refused.error.find("--tables") != std::string::npos);
}

TEST_CASE("cremed-eval drive writes truth at the times of the estimates, as TUM") {
  const TemporaryFolder folder;
  const std::string tum = folder.file("truth.tum");
  REQUIRE(run_eval(folder, write_drive(folder, {"front"}) + " --truth-tum " + tum).status == 0);
  std::istringstream lines(content(tum));
  std::string line;
  std::getline(lines, line);
  CHECK(line == "1.000000 50.000000 60.000000 0 0 0 0.000000000 1.000000000");
  std::getline(lines, line);
  CHECK(line == "1.100000 51.000000 60.000000 0 0 0 0.000000000 1.000000000");
  int count = 2;
  while (std::getline(lines, line)) ++count;
  CHECK(count == 21);
}

TEST_CASE("cremed-eval drive says what is wrong") {
  const auto row = GENERATE(
      Refusal{"/no/such/file /dev/null", 1, "/dev/null: line 1: no header"},
      Refusal{"/no/such/file", 2, "TRUTH"},
      Refusal{"a b --wheels-std 0.02", 2, "--wheels-std: '0.02' has the wrong number"},
      Refusal{"a b --truth-std 1,2,3,4,5", 2, "--truth-std: '1,2,3,4,5' has the wrong number"},
      Refusal{"a b --truth-std 1,-2", 2, "--truth-std: '-2' is not a number >= 0"},
      Refusal{"TRUTH TRUTH --wheels TRUTH", 1, "no column speed_mps"});
  CAPTURE(row.arguments);
  const TemporaryFolder folder;
  write_drive(folder, {"front"});
  check(run_eval(folder, "drive " + with_file(row.arguments, "TRUTH", folder.file("truth.csv"))),
        row);
}

TEST_CASE(
    "cremed-eval drive --baselines puts the methods of others beside ours, on the same scans") {
  const TemporaryFolder folder;
  std::ofstream(folder.file("radars.toml"))
      << "[[radar]]\nname = \"front\"\ntype = \"ars408\"\ninterface = \"can0\"\n"
         "mount = { x_m = 3.4, y_m = 0.0, yaw_rad = 0.0 }\n"
         "[[radar]]\nname = \"rear\"\ntype = \"ars408\"\ninterface = \"can1\"\n"
         "mount = { x_m = -0.6, y_m = 0.0, yaw_rad = 3.1 }\n";
  const std::string config = " --config " + folder.file("radars.toml");
  const std::string log = folder.file("drive.log");
  REQUIRE(run_tool("cremed-simulate", folder,
                   "--scenario bends --duration 12" + config + " --output " + log + " --truth " +
                       folder.file("true.csv"))
              .status == 0);
  REQUIRE(run_tool("cremed", folder,
                   "--replay " + log + config + " --lcm-url none --output-csv " +
                       folder.file("odometry.csv"))
              .status == 0);
  const std::string drive = "drive " + folder.file("odometry.csv") + " " + folder.file("true.csv");
  const ToolRun result = run_eval(folder, drive + config + " --baselines " + log);
  CAPTURE(result.error, result.output);
  REQUIRE(result.status == 0);
  const auto rows = cells(result.output);
  REQUIRE(rows.size() == 6);
  CHECK(rows[3][0] == "kellner");
  CHECK(rows[4][0] == "submap");
  CHECK(rows[5][0] == "submap_80");
  // All on the same windows.
  const auto windows = words(result.output, "fused              5 s ")[0];
  CHECK(std::stoi(windows) == 13);
  for (const std::size_t baseline : {3, 4, 5}) {
    std::string name = rows[baseline][0];
    name.resize(16, ' ');
    CHECK(words(result.output, name + "   5 s ")[0] == windows);
    CHECK(std::stoi(rows[baseline][1]) > 120);
    CHECK(std::stod(rows[baseline][2]) < 0.03);
    CHECK(std::stod(rows[baseline][3]) < 0.4);
    CHECK(std::stod(rows[baseline][2]) > 0.0);
  }
  CHECK(run_eval(folder, drive + " --baselines " + log).status == 2);
  CHECK(run_eval(folder, drive + config).status == 2);
}

TEST_CASE("Truth that cannot be that of the drive is asked about") {
  struct Row {
    const char* what;
    const char* truth;
    const char* told;
  };
  const std::string header = "utime,x_m,y_m,yaw_rad\n";
  const Row row = GENERATE(Row{"header only", "", "no row but the header"},
                           Row{"another time", "9000000,0,0,0\n9900000,10,0,0\n",
                               "its time, utime 9000000 to 9900000, has no motion"},
                           Row{"integer seconds", "1,50,60,0\n3,70,60,0\n", "in microseconds?"},
                           Row{"seconds", "1.0,50,60,0\n3.0,70,60,0\n", "is it in seconds?"},
                           Row{"degrees", "1000000,50,60,90\n2000000,50,70,90\n3000000,50,80,90\n",
                               "yaw_rad: is it in degrees?"});
  CAPTURE(row.what);
  const TemporaryFolder folder;
  const std::string drive = write_drive(folder, {"front"});
  std::ofstream(folder.file("truth.csv")) << header << row.truth;
  const ToolRun result = run_eval(folder, drive);
  CHECK(result.status == 1);
  CHECK(result.output.empty());
  CHECK_THAT(result.error, Catch::Contains(folder.file("truth.csv")));
  CHECK_THAT(result.error, Catch::Contains(row.told));
}

TEST_CASE("Wheels that cannot be those of the drive are refused") {
  struct Row {
    const char* what;
    const char* wheels;
    const char* told;
  };
  const Row row = GENERATE(Row{"header only", "", "no row but the header"},
                           Row{"another time", "9000000,10,0\n9900000,10,0\n",
                               "its time, utime 9000000 to 9900000, has no motion of"},
                           Row{"nanoseconds", "1000000000,10,0\n3000000000,10,0\n",
                               "in it that truth has too; is it of the same drive, and in "
                               "microseconds? The odometry has utime "
                               "1000000 to 3000000"},
                           Row{"seconds", "1.0,10,0\n3.0,10,0\n", "is it in seconds?"});
  CAPTURE(row.what);
  const TemporaryFolder folder;
  const std::string wheels = write_wheels(folder);
  std::ofstream(folder.file("wheels.csv")) << "utime,speed_mps,yaw_rate_radps\n" << row.wheels;
  const ToolRun result = run_eval(folder, write_drive(folder, {"front"}) + wheels);
  CHECK(result.status == 1);
  CHECK(result.output.empty());
  CHECK_THAT(result.error, Catch::Contains(folder.file("wheels.csv")));
  CHECK_THAT(result.error, Catch::Contains(row.told));
}

TEST_CASE("cremed-eval drive knows nothing of the time in which truth or wheels are missing") {
  const TemporaryFolder folder;
  const std::string drive = write_drive(folder, {"front"}) + write_wheels(folder);
  // What is missing was driven at twice the speed.
  std::ofstream truth(folder.file("truth.csv"));
  std::ofstream wheels(folder.file("wheels.csv"));
  truth << "utime,x_m,y_m,yaw_rad\n";
  wheels << "utime,speed_mps,yaw_rate_radps\n";
  for (int i = 0; i <= 20; ++i) {
    if (i <= 8 || i >= 15) {
      truth << 1'000'000 + 100'000 * i << ',' << (i <= 8 ? 50 : 56) + i << ",60,0\n";
      wheels << 1'000'000 + 100'000 * i << ",10,0\n";
    }
  }
  truth.close();
  wheels.close();
  const ToolRun result = run_eval(folder, drive);
  CAPTURE(result.error);
  REQUIRE(result.status == 0);
  CHECK(cells(result.output)[0][1] == "13");
  CHECK(cells(result.output)[0][2] == "0.01000");
  CHECK(words(result.output, "front           x m/s ")[0] == "13");
  CHECK_THAT(result.error,
             Catch::Contains("truth.csv: 0.7 s are missing, nothing from 0.8 s to 1.5 s\n") &&
                 Catch::Contains("wheels.csv: 0.7 s are missing, nothing from 0.8 s to 1.5 s\n"));
  const auto json = nlohmann::json::parse(run_eval(folder, drive + " --json").output);
  REQUIRE(json["truth_gaps"].size() == 1);
  CHECK(json["truth_gaps"][0]["begin_us"] == 1'800'000);
  CHECK(json["wheels_gaps"][0]["end_us"] == 2'500'000);
}

TEST_CASE("cremed-eval drive says that the rows of truth are far apart") {
  const TemporaryFolder folder;
  const std::string drive = write_drive(folder, {"front"});
  const auto told = [&](std::int64_t step_us) {
    std::ofstream truth(folder.file("truth.csv"));
    truth << "utime,x_m,y_m,yaw_rad\n";
    for (int i = 0; i <= 8; ++i) {
      truth << 1'000'000 + step_us * i << ',' << 50 + i << ",60,0\n";
    }
    truth.close();
    const ToolRun result = run_eval(folder, drive);
    CHECK(result.status == 0);
    return result.error;
  };
  CHECK_THAT(told(300'000), Catch::Contains("truth.csv: a row every 0.3 s only: "));
  CHECK_THAT(told(250'000), !Catch::Contains("truth.csv"));
}

TEST_CASE("Odometry and truth in the wrong order are recognised") {
  const TemporaryFolder folder;
  write_drive(folder, {"front"});
  const ToolRun result =
      run_eval(folder, "drive " + folder.file("truth.csv") + " " + folder.file("odometry.csv"));
  CHECK(result.status == 1);
  CHECK_THAT(result.error, Catch::Contains("ODOMETRY comes before TRUTH"));
}

TEST_CASE("A byte order mark is no part of a table") {
  const TemporaryFolder folder;
  const std::string drive = write_drive(folder, {"front"});
  const std::string plain = run_eval(folder, drive).output;
  for (const char* name : {"truth.csv", "odometry.csv"}) {
    const std::string text = content(folder.file(name));
    std::ofstream(folder.file(name)) << "\xEF\xBB\xBF" << text;
  }
  CHECK(run_eval(folder, drive).output == plain);
}

TEST_CASE("Odometry without an estimate is no result") {
  const TemporaryFolder folder;
  const ToolRun result = run_eval(folder, write_drive(folder, {"blind"}));
  CHECK(result.status == 1);
  CHECK_THAT(result.error, Catch::Contains("no estimate in it"));
}

TEST_CASE("A picture that cannot be drawn is a line that says why") {
  const TemporaryFolder folder;
  const std::string drive = write_drive(folder, {"front"});
  const ToolRun other = run_eval(folder, drive + " --plot " + folder.file("picture.xyz"));
  CHECK(other.status == 2);
  CHECK_THAT(other.error, Catch::Contains(".png, .svg"));

  std::ofstream(folder.file("matplotlib.py")) << "raise ImportError('no', name='matplotlib')\n";
  REQUIRE(::setenv("PYTHONPATH", folder.file("").c_str(), 1) == 0);
  const ToolRun without = run_eval(folder, drive + " --plot " + folder.file("picture.png"));
  ::unsetenv("PYTHONPATH");
  CHECK(without.status == 1);
  CHECK_THAT(without.error, Catch::Contains("matplotlib is missing: install python3-matplotlib"));
  CHECK_THAT(without.error, !Catch::Contains("Traceback"));

  std::filesystem::create_directory(folder.file("bin"));
  const std::string alone = folder.file("bin/cremed-eval");
  std::filesystem::copy_file(std::string(CREMED_BINARY_DIR) + "/bin/cremed-eval", alone);
  check(run_program(alone, folder, drive + " --plot " + folder.file("picture.png")),
        {"", 1, "apt-get install cremed-laboratory"});
}
