// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Calibration of simulated drives from a wrong configuration finds the changes.
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/scan/degrees.hpp"
#include "test/tools/pipeline_bench.hpp"
#include "tools/eval/calibrate/calibration.hpp"
#include "tools/eval/temporary_folder.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

constexpr double kGoalDeg = 0.3;

/// Ahead, to the left, back; the last one a GPR on request.
std::vector<RadarConfiguration> three_radars(bool with_gpr) {
  std::vector<RadarConfiguration> radars = {
      radar("front", "can0", {3.4, 0.0, 0.02}, Ars408Options{}),
      radar("left", "can1", {2.4, 0.8, 1.55}, Ars408Options{}),
      radar("rear", "can2", {-0.6, -0.6, -3.05}, Ars408Options{})};
  if (with_gpr) {
    radars[2].decoder = BoschGprOptions{};
  }
  return radars;
}

/// A drive on disk, and its radars' true parameters.
struct RecordedDrive {
  TemporaryFolder folder;
  std::vector<RadarConfiguration> radars;
  std::string log;
  std::unique_ptr<TrueTrajectory> truth;

  RecordedDrive(const char* name, unsigned seed, double duration_s, bool with_gpr = false)
      : RecordedDrive(scenario(name), three_radars(with_gpr), seed, duration_s) {}

  RecordedDrive(const Scenario& scenario, const std::vector<RadarConfiguration>& with,
                unsigned seed, double duration_s)
      : radars(with), log(folder.file("drive.log")) {
    SimulationOptions options;
    options.seed = seed;
    options.duration_s = duration_s;
    const Drive simulated = drive(scenario, radars, exactly_mounted(options));
    std::ofstream(log) << simulated.log();
    truth = std::make_unique<TrueTrajectory>(truth_of(simulated));
  }
};

double degrees_off(const RadarConfiguration& found, const RadarConfiguration& truth) {
  const double off_rad =
      found.ego_motion.vehicle_from_radar.yaw_rad - truth.ego_motion.vehicle_from_radar.yaw_rad;
  return std::abs(std::remainder(off_rad, 2.0 * std::numbers::pi)) / kRadPerDeg;
}

TEST_CASE("mounts that are two degrees off are found again, without truth") {
  struct Row {
    const char* scenario;
    unsigned seed;
    bool with_gpr;
  };
  const auto row = GENERATE(Row{"city", 1, false}, Row{"bends", 2, true}, Row{"straight", 3, false},
                            Row{"bends", 4, false});
  CAPTURE(row.scenario, row.seed);
  const RecordedDrive recorded(row.scenario, row.seed, 40.0, row.with_gpr);
  Configuration wrong = configuration_of(recorded.radars);
  double sign = 1.0;
  for (RadarConfiguration& radar : wrong.radars) {
    radar.ego_motion.vehicle_from_radar.yaw_rad += sign * 2.0 * kRadPerDeg;
    sign = -sign;
  }
  const Calibration calibration = calibrate(wrong, {recorded.log}, nullptr);
  const auto& calibrations = calibration.radars;
  const Configuration found = calibrated(wrong, calibration);
  for (std::size_t i = 0; i < found.radars.size(); ++i) {
    const double off_deg = degrees_off(found.radars[i], recorded.radars[i]);
    const double std_deg = calibrations[i].fit.std[kYaw] / kRadPerDeg;
    CAPTURE(found.radars[i].name, off_deg, std_deg);
    CHECK(calibrations[i].is_changed[kYaw]);
    CHECK(off_deg < kGoalDeg);
    CHECK(off_deg < 3.0 * std_deg);
    CHECK(std_deg < 0.5);  // That of the rolling direction is 0.43.
  }
}

TEST_CASE("a yaw by which a radar moves sideways or backwards is found from any other") {
  const RecordedDrive recorded("bends", 2, 40.0, true);
  Configuration wrong = configuration_of(recorded.radars);
  SECTION("all are said to look ahead") {
    for (RadarConfiguration& radar : wrong.radars) {
      radar.ego_motion.vehicle_from_radar.yaw_rad = 0.0;
    }
  }
  SECTION("one of three is said to look back, about which its directions scatter") {
    wrong.radars[0].ego_motion.vehicle_from_radar.yaw_rad += std::numbers::pi;
  }
  SECTION("the only one is said to look to the left") {
    wrong.radars.resize(1);
    wrong.radars[0].ego_motion.vehicle_from_radar.yaw_rad += 1.4;
  }
  const Calibration calibration = calibrate(wrong, {recorded.log}, nullptr);
  const Configuration found = calibrated(wrong, calibration);
  for (std::size_t i = 0; i < found.radars.size(); ++i) {
    const double off_deg = degrees_off(found.radars[i], recorded.radars[i]);
    CAPTURE(found.radars[i].name, off_deg);
    CHECK(off_deg < 1.0);
  }
  if (found.radars.size() == 1) {
    CHECK(calibration.radars[0].turned_rad == Approx(-1.4).margin(0.1));
  }
}

TEST_CASE("a vehicle that reverses does not turn its radars") {
  const RecordedDrive recorded("reversing", 6, 40.0);
  const Configuration configuration = configuration_of(recorded.radars);
  for (const RadarCalibration& radar : calibrate(configuration, {recorded.log}, nullptr).radars) {
    CHECK(radar.turned_rad == 0.0);
  }
}

TEST_CASE("each fault of a radar shows in what is found for it, and in nothing else") {
  const RecordedDrive recorded("bends", 5, 60.0);
  Configuration wrong = configuration_of(recorded.radars);
  RadarConfiguration& front = wrong.radars[0];
  RadarConfiguration& left = wrong.radars[1];
  RadarConfiguration& rear = wrong.radars[2];
  front.ego_motion.correction.azimuth_std_factor = 0.5;
  left.stamp_offset_s = 0.03;
  left.ego_motion.correction.range_std_factor = 0.6;
  rear.ego_motion.correction.doppler_offset_mps = 0.6;
  rear.ego_motion.correction.doppler_std_factor = 0.5;
  const Configuration found = calibrated(wrong, calibrate(wrong, {recorded.log}, nullptr));

  const auto correction = [&](std::size_t i) { return found.radars[i].ego_motion.correction; };
  CHECK(correction(0).azimuth_std_factor == Approx(1.0).margin(0.1));
  CHECK(found.radars[1].stamp_offset_s == Approx(0.0).margin(0.012));
  CHECK(correction(1).range_std_factor == Approx(1.0).margin(0.1));
  CHECK(correction(2).doppler_offset_mps == Approx(0.0).margin(0.1));
  CHECK(correction(2).doppler_std_factor == Approx(1.0).margin(0.1));

  CHECK(correction(0).doppler_offset_mps == 0.0);
  CHECK(correction(1).doppler_offset_mps == 0.0);
  CHECK(found.radars[2].stamp_offset_s == 0.0);
  for (std::size_t i = 0; i < found.radars.size(); ++i) {
    CHECK(degrees_off(found.radars[i], recorded.radars[i]) < kGoalDeg);
  }
}

/// The simulated vehicle rolls along the x axis of its mounts; in this frame it rolls at an angle.
void turn_frame(RadarConfiguration& radar, double roll_rad) {
  Pose2& mount = radar.ego_motion.vehicle_from_radar;
  const double c = std::cos(roll_rad);
  const double s = std::sin(roll_rad);
  mount = {c * mount.x_m - s * mount.y_m, s * mount.x_m + c * mount.y_m, mount.yaw_rad + roll_rad};
}

/// The changes of each radar's configuration, as the states that compensate them.
CalibrationVector disturb(RadarConfiguration& radar, std::mt19937& random) {
  std::normal_distribution<double> normal;
  CalibrationVector truth{};
  Pose2& mount = radar.ego_motion.vehicle_from_radar;
  DetectionCorrection& correction = radar.ego_motion.correction;
  truth[kYaw] = mount.yaw_rad;
  truth[kX] = mount.x_m;
  truth[kY] = mount.y_m;
  mount.yaw_rad += 0.0075 * normal(random);  // mount_yaw_std_rad
  mount.x_m += 0.05 * normal(random);
  mount.y_m += 0.05 * normal(random);
  radar.stamp_offset_s = 0.01 * normal(random);
  correction.doppler_offset_mps = 0.05 * normal(random);
  correction.doppler_scale = 1.0 + 0.003 * normal(random);
  truth[kLead] = 0.02 * normal(random);
  correction.rotation_lead_s -= truth[kLead];
  truth[kOffset] = -correction.doppler_offset_mps * correction.doppler_scale;
  truth[kStamp] = -radar.stamp_offset_s;
  truth[kScale] = correction.doppler_scale - 1.0;
  truth[kAzimuth] = correction.azimuth_scale - 1.0;
  correction.azimuth_scale = 1.0;
  return truth;
}

/// The first radar's values, to which the others are relative.
void make_relative(CalibrationVector& truth, const CalibrationVector& first, double first_y_m) {
  truth[kY] += first_y_m - first[kY];
  truth[kStamp] -= first[kStamp];
  truth[kScale] -= first[kScale];
}

TEST_CASE("what is found is as good as it says, over ten drives") {
  struct Sum {
    double squares = 0.0;
    int count = 0;
  };
  std::array<Sum, kCalibrationStates> sums;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const RecordedDrive recorded("bends", seed, 40.0);
    Configuration wrong = configuration_of(recorded.radars);
    std::mt19937 random(seed);
    std::vector<CalibrationVector> truths;
    for (RadarConfiguration& radar : wrong.radars) {
      truths.push_back(disturb(radar, random));
    }
    const auto found = calibrate(wrong, {recorded.log}, nullptr, {.doppler_offset = 0.0}).radars;
    const CalibrationVector first = truths.front();
    for (std::size_t i = 0; i < found.size(); ++i) {
      make_relative(truths[i], first, wrong.radars[0].ego_motion.vehicle_from_radar.y_m);
      const FittedRadar& fit = found[i].free;
      for (const CalibrationState state : {kYaw, kX, kY, kOffset, kStamp, kScale, kLead}) {
        if (fit.prior_std[state] == 0.0 || fit.std[state] > 0.5 * fit.prior_std[state]) {
          continue;  // Weakly determined: the prior would be tested, not the fit.
        }
        const double z =
            std::remainder(fit.value[state] - truths[i][state], 2.0 * std::numbers::pi) /
            fit.std[state];
        CAPTURE(seed, i, state, fit.value[state], truths[i][state], fit.std[state]);
        CHECK(std::abs(z) < 4.5);
        sums[state].squares += z * z;
        ++sums[state].count;
      }
    }
  }
  for (const CalibrationState state : {kYaw, kX, kY, kOffset, kStamp, kScale, kLead}) {
    const double nees = sums[state].squares / std::max(sums[state].count, 1);
    CAPTURE(state, nees, sums[state].count);
    CHECK(nees < 1.4);
    CHECK((sums[state].count < 10 || nees > 0.4));
  }
}

TEST_CASE("azimuth scales and slip are as good as they say, over ten drives") {
  double scales = 0.0;
  double slips = 0.0;
  int count = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    std::mt19937 random(100 + seed);
    std::normal_distribution<double> normal;
    Scenario slipping = scenario("bends");
    const double slip = 0.003 + 0.002 * normal(random);
    slipping.course.slip_per_lateral_acceleration = slip;
    std::vector<RadarConfiguration> radars = three_radars(false);
    for (RadarConfiguration& radar : radars) {
      radar.ego_motion.correction.azimuth_scale = 1.0 + 0.01 * normal(random);
    }
    const RecordedDrive recorded(slipping, radars, seed, 40.0);
    Configuration wrong = configuration_of(radars);
    for (RadarConfiguration& radar : wrong.radars) {
      radar.ego_motion.correction.azimuth_scale = 1.0;
    }
    // The simulated Doppler lacks these systematic errors.
    const Calibration found =
        calibrate(wrong, {recorded.log}, nullptr, {.doppler_azimuth = 0.002, .slip = 0.0});
    slips += std::pow((found.vehicle.value[kSlip] - slip) / found.vehicle.std[kSlip], 2.0);
    for (std::size_t i = 0; i < radars.size(); ++i) {
      const FittedRadar& fit = found.radars[i].free;
      const double scale = radars[i].ego_motion.correction.azimuth_scale;
      const double z = (1.0 + fit.value[kAzimuth] - scale) / fit.std[kAzimuth];
      CAPTURE(seed, i, scale, fit.value[kAzimuth], fit.std[kAzimuth]);
      CHECK(std::abs(z) < 4.0);
      CHECK(fit.std[kAzimuth] < 0.008);
      scales += z * z;
      ++count;
    }
  }
  CAPTURE(scales / count, slips / 10.0);
  CHECK(scales / count < 1.4);
  CHECK(scales / count > 0.2);
  CHECK(slips / 10.0 < 2.3);  // 99 % of ten independent values are below.
  CHECK(slips / 10.0 > 0.25);
}

TEST_CASE("with truth, lever arms come out as well") {
  const RecordedDrive recorded("bends", 6, 60.0);
  Configuration wrong = configuration_of(recorded.radars);
  for (RadarConfiguration& radar : wrong.radars) {
    radar.ego_motion.vehicle_from_radar.x_m += 0.25;
  }
  wrong.radars[0].ego_motion.vehicle_from_radar.y_m -= 0.2;
  const Calibration calibration = calibrate(wrong, {recorded.log}, recorded.truth.get());
  const auto& calibrations = calibration.radars;
  const Configuration found = calibrated(wrong, calibration);
  for (std::size_t i = 0; i < found.radars.size(); ++i) {
    const CalibrationVector& std = calibrations[i].fit.std;
    CAPTURE(found.radars[i].name, std[kX], std[kY]);
    CHECK(found.radars[i].ego_motion.vehicle_from_radar.x_m ==
          Approx(recorded.radars[i].ego_motion.vehicle_from_radar.x_m).margin(3.5 * std[kX]));
    CHECK(std[kX] < 0.03);
  }
  CHECK(found.radars[0].ego_motion.vehicle_from_radar.y_m ==
        Approx(0.0).margin(3.5 * calibrations[0].fit.std[kY]));
}

TEST_CASE("with truth, so does the clock that all radars share") {
  const RecordedDrive recorded("stop-and-go", 8, 50.0);
  Configuration wrong = configuration_of(recorded.radars);
  for (RadarConfiguration& radar : wrong.radars) {
    radar.stamp_offset_s = -0.04;
  }
  const Calibration calibration = calibrate(wrong, {recorded.log}, recorded.truth.get());
  const auto& calibrations = calibration.radars;
  const Configuration found = calibrated(wrong, calibration);
  for (const std::size_t i : {0U, 2U}) {  // A lateral radar sees no speed to compare.
    CAPTURE(found.radars[i].name, calibrations[i].fit.std[kStamp]);
    CHECK(found.radars[i].stamp_offset_s ==
          Approx(0.0).margin(3.5 * calibrations[i].fit.std[kStamp]));
    CHECK(calibrations[i].is_changed[kStamp]);
  }
}

TEST_CASE("azimuth scales and the rear axle's slip are found and written where they matter") {
  Scenario slipping = scenario("bends");
  slipping.course.slip_per_lateral_acceleration = 0.006;
  std::vector<RadarConfiguration> radars = three_radars(false);
  radars[0].ego_motion.correction.azimuth_scale = 1.03;
  const RecordedDrive recorded(slipping, radars, 9, 60.0);
  Configuration wrong = configuration_of(recorded.radars);
  wrong.radars[0].ego_motion.correction.azimuth_scale = 1.0;
  const Calibration calibration = calibrate(wrong, {recorded.log}, recorded.truth.get());
  const Configuration found = calibrated(wrong, calibration);
  CAPTURE(calibration.radars[0].fit.std[kAzimuth], calibration.vehicle.std[kSlip]);
  CHECK(found.radars[0].ego_motion.correction.azimuth_scale == Approx(1.03).margin(0.006));
  CHECK(found.radars[1].ego_motion.correction.azimuth_scale == 1.0);
  CHECK(found.radars[2].ego_motion.correction.azimuth_scale == 1.0);
  CHECK(found.odometry.filter.slip_per_lateral_acceleration == Approx(0.006).margin(0.002));
}

TEST_CASE(
    "without truth, what mounts turn by in common is no better known than the rolling direction") {
  const RecordedDrive recorded("bends", 10, 40.0);
  Configuration wrong = configuration_of(recorded.radars);
  for (RadarConfiguration& radar : wrong.radars) {
    turn_frame(radar, 0.4 * kRadPerDeg);
  }
  const Calibration calibration = calibrate(wrong, {recorded.log}, nullptr);
  const double roll_rad = calibration.vehicle.value[kRoll];
  CHECK(calibration.vehicle.std[kRoll] > 0.15 * kRadPerDeg);
  CHECK(std::abs(roll_rad - 0.4 * kRadPerDeg) < 2.0 * calibration.vehicle.std[kRoll]);
  for (std::size_t i = 0; i < wrong.radars.size(); ++i) {
    const FittedRadar& fit = calibration.radars[i].free;
    CHECK(fit.std[kYaw] > 0.15 * kRadPerDeg);
    CHECK(std::abs(fit.value[kYaw] - fit.prior[kYaw]) < 2.0 * fit.std[kYaw]);
  }
}

TEST_CASE("a found yaw is written between -pi and pi") {
  const RecordedDrive recorded("bends", 4, 30.0);
  Configuration wrong = configuration_of(recorded.radars);
  wrong.radars[0].ego_motion.vehicle_from_radar.yaw_rad = 2.0 * std::numbers::pi - 0.03;
  const Configuration found = calibrated(wrong, calibrate(wrong, {recorded.log}, nullptr));
  CHECK(found.radars[0].ego_motion.vehicle_from_radar.yaw_rad == Approx(0.02).margin(0.015));
}

TEST_CASE("a drive that tells nothing is refused") {
  const RecordedDrive recorded("standing", 7, 10.0);
  CHECK_THROWS_WITH(calibrate(configuration_of(recorded.radars), {recorded.log}, nullptr),
                    Catch::Contains("the vehicle does not move"));
}

TEST_CASE("truth of another time is refused, not taken for none") {
  const RecordedDrive recorded("bends", 7, 10.0);
  std::vector<std::int64_t> in_ns = recorded.truth->utime_us();
  std::vector<Pose2> poses;
  for (std::int64_t& utime : in_ns) {
    poses.push_back(*recorded.truth->at(utime));
    utime *= 1000;
  }
  const TrueTrajectory truth(in_ns, poses);
  CHECK_THROWS_WITH(calibrate(configuration_of(recorded.radars), {recorded.log}, &truth),
                    Catch::Contains("has no scan of the logs in it"));
}

}  // namespace
