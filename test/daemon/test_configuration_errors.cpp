// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>

#include <catch2/catch.hpp>

#include "test/daemon/configuration_texts.hpp"

namespace cremed {
namespace {

TEST_CASE("text that is not TOML is refused at its line") {
  check_refused({
      {"[[radar]]\nname = front\n", 2, "syntax", "Error while parsing boolean",
       "must be TOML 1.0 (strings in \"quotes\")"},
      {"\n\n[[radar]\n", 3, "syntax", "Error while parsing table header", "expected"},
      {kArs408 + "sensor_id = 1\nsensor_id = 1\n", 7, "syntax", "Error", "cannot redefine"},
      {kArs408 + "sensor_id = 08\n", 6, "syntax", "Error", "leading zeroes are prohibited"},
      {kArs408 + "[output]\ncsv = \"a\n\"\n", 7, "syntax", "Error", "string"},
      {"a = 1\vb\n", 1, "syntax", "Error", "TOML 1.0"},
      {"\n[=]\n", 2, "syntax", "Error while parsing key", "expected bare key"},
      {"[[ #radar]]\n", 1, "syntax", "Error while parsing key", "expected bare key"},
  });
}

std::string repeated(std::size_t times, const std::string& text, std::string all = "") {
  for (std::size_t i = 0; i < times; ++i) {
    all += text;
  }
  return all;
}

TEST_CASE("nesting that would overflow the stack is refused") {
  const std::string deepest_dots = repeated(128, ".a", "a");
  check_refused({
      {repeated(100'000, ".a", "\na") + " = 1\n", 2, "syntax", "too many dots", "at most 128"},
      {repeated(50'000, " . a", "[a") + "]\n", 1, "syntax", "too many dots", "at most 128"},
      {repeated(129, ".\"a\"", "[[a") + "]]\n", 1, "syntax", "too many dots", "at most 128"},
      {repeated(100'000, "[", "\na = "), 2, "syntax", "Error", "maximum nested value depth of 16"},
      {repeated(80'000, "{a=", "a = "), 1, "syntax", "Error", "maximum nested value depth of 16"},
      {repeated(17, "[", "a = ") + repeated(17, "]"), 1, "syntax", "Error", "depth of 16"},
      {std::string(262'145, '\n'), 1, "file", "is too large", "at most 256 KiB"},
      // The greatest depth: read, destroyed, and refused for its first key.
      {kArs408 + repeated(7, deepest_dots + " = [\n{") + deepest_dots + " = 1" + repeated(7, "}]"),
       6, "radar.a", "unknown key", "must be one of"},
  });
}

TEST_CASE("a line of dots nests nothing") {
  CHECK(message_of(repeated(500, ".", "# ") + repeated(500, ". ", "\n# ") + "\n" + kArs408) ==
        "accepted");
  CHECK(message_of(std::string(262'144 - kArs408.size(), '\n') + kArs408) == "accepted");
}

TEST_CASE("characters beyond ASCII stand in comments and as escapes only") {
  const std::string right = "written in a \"string\" as its number, like \\u00E9";
  check_refused({
      {"\n\u00A7 = 1\n", 2, "syntax", "a character is not ASCII", right},
      {"a = \"\"\"\\\n\u00A7\"\"\"\n", 2, "syntax", "a character is not ASCII", right},
      {"a = '#\u00E9'\n", 1, "syntax", "a character is not ASCII", right},
      {"a = \"\\\"#\u00E9\"\n", 1, "syntax", "a character is not ASCII", right},
      {"\"#\"\u00E9 = 1\n", 1, "syntax", "a character is not ASCII", right},
      {"# \u00E9\n\xFF\n", 2, "syntax", "a character is not ASCII", right},
  });
  const std::string good = "\xEF\xBB\xBF# \u00FCber 80\u00B0 \xFF\n" + kArs408 +
                           "sensor_id = 0 # 'f\u00FCr'\n[output]\ncsv = \"a#\\u00E9\" # \u00E9\n";
  CHECK(parse_configuration(good, "").output.csv == "a#\u00E9");
}

TEST_CASE("values of the wrong type are refused") {
  check_refused({
      {kArs408 + "sensor_id = \"1\"\n", 6, "radar.sensor_id", "is \"1\"", "an integer from 0 to 7"},
      {kArs408 + "sensor_id = 1.0\n", 6, "radar.sensor_id", "is 1.0", "an integer from 0 to 7"},
      {kArs408 + "\nscan_timeout_s = true\n", 7, "radar.scan_timeout_s", "is true", "a number"},
      {kArs408 + "scan_timeout_s = 12:00:00\n", 6, "radar.scan_timeout_s", "is a date or time",
       "a number from 0.001 to 0.06"},
      {kArs408 + "output = 2\n", 6, "radar.output", "is 2", "\"clusters\" or \"objects\""},
      {kArs408 + "limits = 5\n", 6, "radar.limits", "is 5", "a table"},
      {kArs408 + "[[radar.limits]]\n", 6, "radar.limits", "is a list", "a table"},
      {kArs408 + "keep_dyn_props = 1\n", 6, "radar.keep_dyn_props", "is 1", "integers from 0 to 7"},
      {kArs408 + "keep_dyn_props = []\n", 6, "radar.keep_dyn_props", "is empty", "one or more"},
      {kArs408 + "keep_dyn_props = [1,\n  2.0]\n", 6, "radar.keep_dyn_props", "holds 2.0",
       "integers from 0 to 7"},
      {kArs408 + "keep_invalid_states = [0, [4]]\n", 6, "radar.keep_invalid_states", "holds a list",
       "integers from 0 to 31"},
      {kArs408 + "[output]\npublish_scans = 1\n", 7, "output.publish_scans", "is 1",
       "true or false"},
      {kArs408 + "[output]\nnav_msgs_odometry = \"CREMED_ODOMETRY\"\n", 7,
       "output.nav_msgs_odometry", "is \"CREMED_ODOMETRY\"", "not CREMED_..."},
      {kArs408 + "[output]\nnav_msgs_odometry = \"" + std::string(64, 'a') + "\"\n", 7,
       "output.nav_msgs_odometry", "is \"aaa", "up to 63 letters"},
      {kArs408 + "[output]\nnav_msgs_odometry = \"/odometry of mine\"\n", 7,
       "output.nav_msgs_odometry", "is \"/odometry of mine\"", "a channel such as"},
      {kArs408 + "[output]\ncsv = 1\n", 7, "output.csv", "is 1", "a path"},
      {kArs408 + "[estimator]\ndegrees_of_freedom = 2.0\n", 7, "estimator.degrees_of_freedom",
       "is 2.0", "an integer from 2 to 3"},
      {"radar = 3\n", 1, "radar", "is 3", "one or more [[radar]] tables"},
      {"\n[radar]\nname = \"a\"\n", 2, "radar", "is a table", "one or more [[radar]] tables"},
      {"radar = [1]\n", 1, "radar", "is a list", "one or more [[radar]] tables"},
      {"output = 1\n" + kArs408, 1, "output", "is 1", "a table"},
  });
}

TEST_CASE("values out of range are refused with the range") {
  check_refused({
      {kArs408 + "sensor_id = 8\n", 6, "radar.sensor_id", "is 8", "from 0 to 7"},
      {kArs408 + "sensor_id = -1\n", 6, "radar.sensor_id", "is -1", "from 0 to 7"},
      {kArs408 + "sensor_id = 256\n", 6, "radar.sensor_id", "is 256", "from 0 to 7"},
      {kArs408 + "min_existence_code = 8\n", 6, "radar.min_existence_code", "is 8", "from 0 to 7"},
      {kArs408 + "keep_dyn_props = [1, 8]\n", 6, "radar.keep_dyn_props", "holds 8", "from 0 to 7"},
      {kArs408 + "keep_invalid_states = [32]\n", 6, "radar.keep_invalid_states", "holds 32",
       "from 0 to 31"},
      {kArs408 + "scan_timeout_s = 0\n", 6, "radar.scan_timeout_s", "is 0", "from 0.001 to 0.06"},
      {kArs408 + "scan_timeout_s = 0.0600001\n", 6, "radar.scan_timeout_s", "is 0.0600001",
       "from 0.001 to 0.06"},
      {kArs408 + "scan_timeout_s = nan\n", 6, "radar.scan_timeout_s", "is nan",
       "from 0.001 to 0.06"},
      {kArs408 + "limits.max_range_m = inf\n", 6, "radar.limits.max_range_m", "is inf",
       "from 0 to 2000"},
      {kArs408 + "limits.min_rcs_dbm2 = -inf\n", 6, "radar.limits.min_rcs_dbm2", "is -inf",
       "from -100 to 100"},
      {kArs408 + "limits.max_abs_azimuth_rad = 90\n", 6, "radar.limits.max_abs_azimuth_rad",
       "is 90", "from 0.01 to 3.1416"},
      {kGpr + "base_id = 0x7A1\n", 6, "radar.base_id", "is 0x7A1", "from 0x0 to 0x7A0"},
      {kGpr + "info_id = -1\n", 6, "radar.info_id", "is -1", "from 0x0 to 0x7FF"},
      {kGpr + "info_id = 2048\n", 6, "radar.info_id", "is 0x800", "from 0x0 to 0x7FF"},
      {kGpr + "min_existence = 0.97\n", 6, "radar.min_existence", "is 0.97", "from 0 to 0.96875"},
      {kArs408 + "[estimator]\ndegrees_of_freedom = 6\n", 7, "estimator.degrees_of_freedom", "is 6",
       "from 2 to 3"},
      {kArs408 + "[estimator.outlier_ray]\nweight = 1.0\n", 7, "estimator.outlier_ray.weight",
       "is 1.0", "from 0 to 0.99"},
      {kArs408 + "[radar.estimator.doppler]\nmoving_weight = -0.1\n", 7,
       "radar.estimator.doppler.moving_weight", "is -0.1", "from 0 to 0.99"},
      {kArs408 + "[estimator]\nmin_targets = 300\n", 7, "estimator.min_targets", "is 300",
       "from 2 to 256"},
      {kArs408 + "[estimator]\nmin_targets = 99999999999\n", 7, "estimator.min_targets",
       "is 99999999999", "from 2 to 256"},
      {kArs408 + "[estimator]\nmax_iterations = 100\n", 7, "estimator.max_iterations",
       "unknown key", "one of"},
      {kArs408 + "[odometry]\nacceleration_std_mps2 = 0\n", 7, "odometry.acceleration_std_mps2",
       "is 0", "from 0.01 to 100"},
      {kArs408 + "[odometry]\nlost_s = 61\n", 7, "odometry.lost_s", "is 61", "from 0.01 to 60"},
      {kArs408 + "[odometry]\nslip_std_rad = 1.1\n", 7, "odometry.slip_std_rad", "is 1.1",
       "from 0 to 1"},
      {kArs408 + "[odometry]\nbody_velocity_std_mps = -0.1\n", 7, "odometry.body_velocity_std_mps",
       "is -0.1", "from 0 to 10"},
      {kArs408 + "[odometry]\nmax_doppler_nis = 16\n", 7, "odometry.max_doppler_nis", "unknown key",
       "one of"},
      {kArs408 + "[odometry]\nenabled = 1\n", 7, "odometry.enabled", "is 1", "true or false"},
      {kArs408 + "[odometry]\nenable = true\n", 7, "odometry.enable", "unknown key", "enabled"},
  });
}

TEST_CASE("the ends of a range are in it") {
  for (const char* key : {"scan_timeout_s = 0.001", "scan_timeout_s = 0.06", "sensor_id = 0",
                          "sensor_id = 7", "keep_dyn_props = [0, 7]", "limits.min_rcs_dbm2 = -100",
                          "limits.max_range_m = 2000.0", "limits.min_range_m = 0"}) {
    CHECK(message_of(std::string(kArs408).append(key)) == "accepted");
  }
}

TEST_CASE("strings that cannot work are refused") {
  const std::string radar =
      "[[radar]]\ntype = \"ars408\"\nmount = {x_m = 1, y_m = 1, yaw_rad = 1}\n";
  const std::string name = radar + "name = \"a\"\n";
  const std::string interface = radar + "interface = \"can0\"\n";
  check_refused({
      {interface + "name = \"\"\n", 5, "radar.name", "is \"\"", "1 to 15 letters, digits"},
      {interface + "name = \"front left\"\n", 5, "radar.name", "is \"front left\"", "LCM channel"},
      {interface + "name = \"v\\u00F6rn\"\n", 5, "radar.name", "is \"v\u00F6rn\"", "LCM channel"},
      {interface + "name = \"abcdefghijklmnop\"\n", 5, "radar.name", "is", "1 to 15 letters"},
      {interface + "name = \"fused\"\n", 5, "radar.name", "is \"fused\"",
       "neither \"fused\" nor \"odometry\""},
      {interface + "name = \"odometry\"\n", 5, "radar.name", "is \"odometry\"",
       "neither \"fused\" nor \"odometry\""},
      {interface + "name = \"Odometry\"\n", 5, "radar.name", "is \"Odometry\"",
       "neither \"fused\" nor \"odometry\""},
      {name + "interface = \"\"\n", 5, "radar.interface", "is \"\"", "1 to 15 characters"},
      {name + "interface = \"abcdefghijklmnop\"\n", 5, "radar.interface", "is", "1 to 15"},
      {name + "interface = \"can 0\"\n", 5, "radar.interface", "is", "without space"},
      {name + "interface = \"can/0\"\n", 5, "radar.interface", "is", "without space, '/'"},
      {name + "interface = \"can\\u001b[0m\"\n", 5, "radar.interface", "is \"can?[0m\"", "print"},
      {name + "interface = \"can\\u009b\"\n", 5, "radar.interface", "is \"can?\"", "print"},
      {name + "interface = \"can\\u00000\"\n", 5, "radar.interface", "is \"can?0\"", "1 to 15"},
      {kArs408 + "[logging]\nlevel = \"verbose\"\n", 7, "logging.level", "is \"verbose\"",
       "\"trace\", \"debug\", \"info\", \"warn\", \"error\" or \"off\""},
      {kArs408 + "[output]\nlcm_url = \"\"\n", 7, "output.lcm_url", "is \"\"", "\"none\" or a URL"},
      {kArs408 + "[output]\nlcm_url = \"239.255.76.67:7667\"\n", 7, "output.lcm_url", "is",
       "\"udpm://239.255.76.67:7667?ttl=0\""},
      {kArs408 + "[output]\ncsv = \"a\\nb\"\n", 7, "output.csv", "is \"a?b\"", "a path"},
      {kArs408 + "[estimator]\nlikelihood = \"exact\"\n", 7, "estimator.likelihood", "is \"exact\"",
       "\"exclusive\" or \"max_sum_mixture\""},
      {kGpr + "crc_policy = \"Count\"\n", 6, "radar.crc_policy", "is \"Count\"",
       "\"off\", \"count\" or \"enforce\""},
  });
}

TEST_CASE("unknown keys are refused with the nearest known one") {
  check_refused({
      {kArs408 + "sensorid = 1\n", 6, "radar.sensorid", "unknown key", "mean \"sensor_id\"?"},
      {kArs408 + "limits.max_range = 9\n", 6, "radar.limits.max_range", "unknown key",
       "mean \"max_range_m\"?"},
      {kArs408 + "colour = \"red\"\n", 6, "radar.colour", "unknown key",
       "must be one of \"name\", "},
      {kArs408 + "[outputs]\n", 6, "outputs", "unknown key", "mean \"output\"?"},
      {kArs408 + "[logging]\nfile = \"x\"\n", 7, "logging.file", "unknown key", "one of \"level\""},
      {kArs408 + "[estimator]\nmax_gap = 1\n", 7, "estimator.max_gap", "unknown key",
       "mean \"max_gap_s\"?"},
      {kArs408 + "[estimator.doppler]\nenable = true\n", 7, "estimator.doppler.enable",
       "unknown key", "mean \"enabled\"?"},
      {kArs408 + "[radar.estimator.outlier_ray]\nwieght = 0\n", 7,
       "radar.estimator.outlier_ray.wieght", "unknown key", "mean \"weight\"?"},
      {kArs408 + "[output]\nlevel = \"info\"\n", 7, "output.level", "unknown key", "\"lcm_url\""},
      {kArs408 + "[radar.mounts]\nx_m = 1\n", 6, "radar.mounts", "unknown key", "mean \"mount\"?"},
      {kArs408 + "\"a\\nb\" = 1\n", 6, "radar.a?b", "unknown key", "must be one of"},
      {kArs408 + std::string(5000, 'k') + " = 1\n", 6, "radar." + std::string(60, 'k') + "...",
       "unknown key", "must be one of"},
  });
}

TEST_CASE("keys of the other radar type are refused as such") {
  check_refused({
      {kGpr + "sensor_id = 0\n", 6, "radar.sensor_id", "is a key of type \"ars404\" or \"ars408\"",
       "left out"},
      {kGpr + "keep_dyn_props = [1]\n", 6, "radar.keep_dyn_props",
       "is a key of type \"ars404\" or \"ars408\"", "left out"},
      {kArs408 + "base_id = 0x200\n", 6, "radar.base_id", "is a key of type \"bosch_gpr\"",
       "left out"},
      {kArs408 + "min_existence = 0.5\n", 6, "radar.min_existence",
       "is a key of type \"bosch_gpr\"", "left out"},
      // Not suggested either.
      {kGpr + "sensorid = 0\n", 6, "radar.sensorid", "unknown key", "must be one of"},
  });
}

TEST_CASE("what is missing is named") {
  check_refused({
      {"", 1, "radar", "is missing",
       "one or more [[radar]] tables: `cremed-doctor --suggest-config > my.toml` "},
      {"# nothing\n[output]\n", 1, "radar", "is missing", "one or more [[radar]] tables"},
      {"radar = []\n", 1, "radar", "is a list", "one or more [[radar]] tables"},
      {"\n[[radar]]\ntype = \"ars408\"\ninterface = \"a\"\nmount = {x_m=1,y_m=1,yaw_rad=1}\n", 2,
       "radar.name", "is missing", "1 to 15 letters"},
      {"[[radar]]\nname = \"a\"\ninterface = \"a\"\nmount = {x_m=1,y_m=1,yaw_rad=1}\n", 1,
       "radar.type", "is missing", "\"ars404\", \"ars408\" or \"bosch_gpr\""},
      {"[[radar]]\ntype = \"ars408\"\nname = \"a\"\nmount = {x_m=1,y_m=1,yaw_rad=1}\n", 1,
       "radar.interface", "is missing", "1 to 15 characters"},
      {"[[radar]]\ntype = \"ars408\"\nname = \"a\"\ninterface = \"a\"\n\n[radar.mount]\nx_m = 1\n"
       "y_m = 1\n",
       6, "radar.mount.yaw_rad", "is missing", "a number from -6.2832 to 6.2832"},
  });
}

TEST_CASE("all errors are reported, in the order of the file") {
  const std::string message = message_of(
      "[logging]\nlevel = 1\n[estimator]\nzz_b = 1\nzz_a = 1\n"
      "[[radar]]\nmount = 7\nname = \"a\"\ntype = \"lidar\"\ninterface = \"can0\"\n");
  const std::string expected[] = {
      "test.toml:2: logging.level: ",   "test.toml:4: estimator.zz_b: ",
      "test.toml:5: estimator.zz_a: ",  "test.toml:6: radar.mount.x_m: ",
      "test.toml:6: radar.mount.y_m: ", "test.toml:6: radar.mount.yaw_rad: ",
      "test.toml:7: radar.mount: ",     "test.toml:9: radar.type: ",
  };
  std::size_t at = 0;
  for (const std::string& line : expected) {
    CAPTURE(message, line);
    REQUIRE(message.compare(at, line.size(), line) == 0);
    at = message.find('\n', at) + 1;
  }
  CHECK(at == 0);  // find() returned npos: that was the last line.
}

TEST_CASE("a flood of errors is cut") {
  std::string text = kArs408;
  for (int i = 0; i < 50; ++i) {
    text.append("unknown_").append(std::to_string(i)).append(" = 1\n");
  }
  const std::string message = message_of(text);
  CHECK(std::ranges::count(message, '\n') == 20);
  CHECK_THAT(message, Catch::EndsWith("test.toml: 30 more"));
}

}  // namespace
}  // namespace cremed
