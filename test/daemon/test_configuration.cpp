// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <clocale>
#include <locale>
#include <string>

#include <catch2/catch.hpp>

#include "cremed/can_decoders/bosch_gpr.hpp"
#include "daemon/configuration/configuration.hpp"
#include "test/daemon/configuration_texts.hpp"

namespace cremed {
namespace {

Configuration parse(const std::string& text) { return parse_configuration(text, "test.toml"); }

TEST_CASE("every key of an ARS408 is taken") {
  const Configuration configuration = parse(kArs408 + R"(
scan_timeout_s = 0.04
sensor_id = 7
output = "objects"
keep_invalid_states = [0, 31]
keep_dyn_props = [7]
min_existence_code = 3
limits = { min_range_m = 1.5, max_range_m = 80, max_abs_azimuth_rad = 1.25, min_rcs_dbm2 = -20 }
calibration.stamp_offset_s = -0.02
calibration.rotation_lead_s = 0.03
calibration.azimuth_scale = 1.03
calibration.doppler_offset_mps = 0.3
calibration.range_std_factor = 1.5
calibration.azimuth_std_factor = 2
calibration.doppler_std_factor = 2.5
)");
  const RadarConfiguration& radar = configuration.radars.at(0);
  CHECK(radar.scan_timeout_s == 0.04);
  const auto& decoder = *radar.decoder.as<Ars408Options>();
  CHECK(decoder.sensor_id == 7);
  CHECK(decoder.output == Ars408Output::objects);
  CHECK(decoder.keep_invalid_states == 0x80000001U);
  CHECK(decoder.keep_dyn_props == 0x80U);
  CHECK(decoder.min_existence_code == 3);
  const DetectionLimits& limits = radar.ego_motion.limits;
  CHECK(limits.min_range_m == 1.5);
  CHECK(limits.max_range_m == 80.0);
  CHECK(limits.max_abs_azimuth_rad == 1.25);
  CHECK(limits.min_rcs_dbm2 == -20.0);
  CHECK(radar.stamp_offset_s == -0.02);
  const DetectionCorrection& correction = radar.ego_motion.correction;
  CHECK(correction.rotation_lead_s == 0.03);
  CHECK(correction.azimuth_scale == 1.03);
  CHECK(correction.doppler_offset_mps == 0.3);
  CHECK(correction.range_std_factor == 1.5);
  CHECK(correction.azimuth_std_factor == 2.0);
  CHECK(correction.doppler_std_factor == 2.5);
}

TEST_CASE("a calibrated table takes the place of single keys, wherever it stands") {
  const std::string calibrated = "[calibrated.front]\nyaw_rad = 0.3\nrotation_lead_s = 0.035\n";
  const std::string front = kArs408 + "calibration.doppler_scale = 1.01\n";
  for (const std::string& text : {front + calibrated, calibrated + front}) {
    const EgoMotionOptions options = parse(text).radars.at(0).ego_motion;
    CHECK(options.vehicle_from_radar.x_m == 3.4);
    CHECK(options.vehicle_from_radar.yaw_rad == 0.3);
    CHECK(options.correction.rotation_lead_s == 0.035);
    CHECK(options.correction.doppler_scale == 1.01);
  }
  check_refused({{front + "[calibrated.rear]\nyaw_rad = 0.3\n", 7, "calibrated.rear", "unknown key",
                  "\"front\""},
                 {front + "[calibrated.front]\nyaw_ra = 0.3\n", 8, "calibrated.front.yaw_ra",
                  "unknown key", "yaw_rad"},
                 {kGpr + "[calibrated.left]\nrotation_lead_s = 0.3\n", 7,
                  "calibrated.left.rotation_lead_s", "is a key of type", "left out"}});
}

TEST_CASE("a calibrated slip takes the place of the one in [odometry]") {
  const std::string odometry = "[odometry]\nslip_per_lateral_acceleration = 0.001\n";
  const std::string calibrated = "[calibrated]\nslip_per_lateral_acceleration = 0.003\n";
  for (const std::string& text : {odometry + calibrated, calibrated + odometry}) {
    CHECK(parse(kArs408 + text).odometry.filter.slip_per_lateral_acceleration == 0.003);
  }
}

TEST_CASE("the rotation lead is that of the sensor's type and output unless it is given") {
  const auto lead_s = [](const std::string& radar) {
    return parse(radar).radars.at(0).ego_motion.correction.rotation_lead_s;
  };
  CHECK(lead_s(kArs408) == kArs408RotationLeadS);
  CHECK(lead_s(kArs408 + "output = \"objects\"\n") == 0.0);
  CHECK(lead_s(kArs408 + "calibration.rotation_lead_s = -0.01\n") == -0.01);
  CHECK(lead_s(kGpr) == 0.0);
  CHECK_THROWS_WITH(lead_s(kGpr + "calibration.rotation_lead_s = 0.04\n"),
                    Catch::Contains("rotation_lead_s") && Catch::Contains("left out"));
}

TEST_CASE("the azimuth scale is 1 unless it is given, for every type") {
  const auto scale = [](const std::string& radar) {
    return parse(radar).radars.at(0).ego_motion.correction.azimuth_scale;
  };
  CHECK(scale(kArs408) == 1.0);
  CHECK(scale(kGpr + "calibration.azimuth_scale = 0.98\n") == 0.98);
  CHECK(scale(kArs408 + "[calibrated.front]\nazimuth_scale = 1.02\n") == 1.02);
}

TEST_CASE("every key of a GPR is taken") {
  const Configuration configuration = parse(kGpr + R"(
base_id = 0x300
info_id = 257
crc_policy = "enforce"
invert_azimuth = true
invert_doppler = true
min_existence = 0.5
)");
  const auto& decoder = *configuration.radars.at(0).decoder.as<BoschGprOptions>();
  CHECK(decoder.base_id == 0x300);
  CHECK(decoder.info_id == 0x101);
  CHECK(decoder.crc_policy == CrcPolicy::enforce);
  CHECK(decoder.invert_azimuth);
  CHECK(decoder.invert_doppler);
  CHECK(decoder.min_existence == 0.5);
}

TEST_CASE("every key of the estimator is taken") {
  const Configuration configuration = parse(R"(
[estimator]
degrees_of_freedom = 3
start_scale = 6.5
likelihood = "max_sum_mixture"
min_targets = 8
max_gap_s = 0.25
[estimator.outlier_ray]
weight = 0.2
[estimator.doppler]
enabled = false
moving_weight = 0.1
)" + kArs408);
  const EgoMotionOptions& options = configuration.radars.at(0).ego_motion;
  CHECK(options.registration.degrees_of_freedom == 3);
  CHECK(options.registration.start_scale == 6.5);
  CHECK(options.registration.likelihood == Likelihood::max_sum_mixture);
  CHECK(options.min_targets == 8);
  CHECK(options.max_gap_s == 0.25);
  CHECK(options.registration.outlier_ray.weight == 0.2);
  const DopplerOptions& doppler = options.registration.doppler;
  CHECK_FALSE(doppler.enabled);
  CHECK(doppler.moving_weight == 0.1);
}

TEST_CASE("a radar's own estimator keys override the common ones for that radar alone") {
  const Configuration configuration = parse(R"(
estimator.start_scale = 3
estimator.outlier_ray.weight = 0.1
)" + kArs408 + R"(
[radar.estimator]
start_scale = 4
outlier_ray.weight = 0.2
doppler.enabled = false
)" + radar_text("left", "ars408", "can1"));
  const RegistrationOptions& own = configuration.radars.at(0).ego_motion.registration;
  CHECK(own.start_scale == 4.0);
  CHECK(own.outlier_ray.weight == 0.2);
  CHECK_FALSE(own.doppler.enabled);
  const RegistrationOptions& common = configuration.radars.at(1).ego_motion.registration;
  CHECK(common.start_scale == 3.0);
  CHECK(common.outlier_ray.weight == 0.1);
  CHECK(common.doppler.enabled);
}

TEST_CASE("fused: two radars or more, unless odometry is switched off") {
  const std::string two = kArs408 + radar_text("left", "bosch_gpr", "can1");
  CHECK(is_fused(parse(two)));
  CHECK_FALSE(is_fused(parse(kArs408)));
  CHECK_FALSE(is_fused(parse(two + "[odometry]\nenabled = false\n")));
}

TEST_CASE("odometry: every key reaches the option that it names") {
  const OdometryOptions o = parse(kArs408 + R"(
[odometry]
acceleration_std_mps2 = 1.01
yaw_acceleration_std_radps2 = 1.03
slip_std_rad = 0.05
slip_per_lateral_acceleration = -0.01
body_velocity_std_mps = 1.07
mount_yaw_std_rad = 0.11
doppler_scale_std = 0.13
doppler_offset_std_mps = 1.19
azimuth_scale_std = 0.21
mount_position_std_m = 0.23
min_targets = 22
predicted_s = 1.26
lost_s = 1.27
anchor_period_s = 1.28
max_lateness_s = 0.29
max_gap_s = 1.30
)")
                                .odometry.filter;
  CHECK(std::array{o.acceleration.std, o.yaw_acceleration.std, o.slip_std_rad,
                   o.slip_per_lateral_acceleration,
                   o.body_velocity.std} == std::array{1.01, 1.03, 0.05, -0.01, 1.07});
  CHECK(std::array{o.mount_yaw_std_rad, o.doppler_scale_std, o.offset.std, o.azimuth_scale_std,
                   o.lever_std_m} == std::array{0.11, 0.13, 1.19, 0.21, 0.23});
  CHECK(o.min_targets == 22);
  CHECK(std::array{o.predicted_s, o.lost_s, o.anchor_period_s, o.max_lateness_s, o.max_gap_s} ==
        std::array{1.26, 1.27, 1.28, 0.29, 1.30});
}

TEST_CASE("The trajectory follows the odometry of several radars, or what is named") {
  const std::string two = kArs408 + radar_text("left", "bosch_gpr", "can1");
  const auto source = [](const std::string& text) { return tum_radar(parse(text)); };
  CHECK(source(kArs408) == 0U);
  CHECK_FALSE(source(two));
  CHECK(source(two + "[odometry]\nenabled = false\n") == 0U);
  CHECK(source(two + "[output]\ntum_source = \"left\"\n") == 1U);
  CHECK_FALSE(source(two + "[output]\ntum_source = \"fused\"\n"));
  CHECK_FALSE(source(kArs408 + "[output]\ntum_source = \"odometry\"\n"));
}

TEST_CASE("output and logging are taken") {
  const Configuration configuration = parse(kArs408 + radar_text("left", "bosch_gpr", "can1") + R"(
[output]
lcm_url = "none"
csv = "/tmp/odometry.csv"
tum = "trajectory.tum"
tum_source = "left"
nav_msgs_odometry = "/odometry#nav_msgs.Odometry"
publish_scans = true
[logging]
level = "trace"
)");
  CHECK(configuration.output.lcm_url == "none");
  CHECK(configuration.output.csv == "/tmp/odometry.csv");
  CHECK(configuration.output.tum == "trajectory.tum");
  CHECK(configuration.output.tum_source == "left");
  CHECK(configuration.output.nav_msgs_odometry == "/odometry#nav_msgs.Odometry");
  CHECK(configuration.output.publish_scans);
  CHECK(configuration.logging.level == "trace");
}

TEST_CASE("radars may share an interface if they share no identifier") {
  const std::string ars408 = radar_text("b", "ars408", "can0");
  const std::string gpr = radar_text("b", "bosch_gpr", "can0");
  CHECK(parse(kArs408 + ars408 + "sensor_id = 1\n").radars.size() == 2);
  CHECK(parse(kArs408 + gpr + "base_id = 0x500\n").radars.size() == 2);
  CHECK(parse(kArs408 + "sensor_id = 6\n" + gpr).radars.size() == 2);  // 0x260 and above.
  CHECK(parse(kGpr + gpr + "base_id = 0x260\ninfo_id = 0x101\n").radars.size() == 2);
}

/// Decimal comma and grouped thousands, independent of installed locales.
struct CommaPunctuation : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST_CASE("numbers and messages do not depend on the locale") {
  const std::locale before =
      std::locale::global(std::locale(std::locale::classic(), new CommaPunctuation));
  const std::string c_before = std::setlocale(LC_ALL, nullptr);
  std::setlocale(LC_ALL, "de_DE.UTF-8");  // Where installed.
  double x_m = 0.0;
  std::string message;
  try {
    x_m = parse(kArs408).radars.at(0).ego_motion.vehicle_from_radar.x_m;
    parse(kArs408 + "limits.max_range_m = 1234567.5\n");
  } catch (const ConfigurationError& error) {
    message = error.what();
  }
  std::setlocale(LC_ALL, c_before.c_str());
  std::locale::global(before);
  CHECK(x_m == 3.4);
  CHECK(message ==
        "test.toml:6: radar.limits.max_range_m: is 1234567.5; must be a number from 0 to 2000");
}

}  // namespace
}  // namespace cremed
