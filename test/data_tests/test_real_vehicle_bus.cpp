// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/can_decoders/ars408_commands.hpp"
#include "test/data_tests/real_drive.hpp"
#include "test/tools/odometry_windows.hpp"
#include "test/tools/pipeline_bench.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

struct DriveOfCar {
  const char* name;
  const char* configuration;
};

/// The car's wheels and gyro as a node of the front radar's bus would send them: both every 10 ms,
/// in steps of 0.02 m/s and 0.01 deg/s.
std::vector<CanFrame> frames_of_wheels(const std::string& csv) {
  std::vector<CanFrame> frames;
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  char comma = 0;
  std::int64_t utime_us = 0;
  double speed_mps = 0.0;
  double yaw_rate_radps = 0.0;
  while (lines >> utime_us >> comma >> speed_mps >> comma >> yaw_rate_radps) {
    for (CanFrame frame :
         {encode_ars408_speed(0, speed_mps), encode_ars408_yaw_rate(0, yaw_rate_radps)}) {
      frame.stamp_us = utime_us;
      frames.push_back(frame);
    }
  }
  return frames;
}

std::vector<CanFrame> merged(const std::vector<CanFrame>& a, const std::vector<CanFrame>& b) {
  std::vector<CanFrame> all;
  std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all),
             [](const CanFrame& x, const CanFrame& y) { return x.stamp_us < y.stamp_us; });
  return all;
}

struct Result {
  DriftErrors errors;
  VehicleStatus speed;
  VehicleStatus yaw_rate;
};

Result result_of(const DriveOfCar& scene, bool with_vehicle) {
  const std::string folder = std::string("data/nuscenes/") + scene.name;
  Configuration configuration = configuration_of_car(scene.configuration);
  if (with_vehicle) {
    configuration.vehicle.interface = "can0";
    configuration.odometry.filter.vehicle.speed.is_used = true;
    configuration.odometry.filter.vehicle.yaw_rate.is_used = true;
  }
  const auto radars = read_frames(read_shared(folder + "/can.log.xz"), configuration);
  const auto frames = merged(frames_of_wheels(read_shared(folder + "/wheels.csv")), radars);
  RecordingSink sink(configuration.radars.size());
  Pipeline pipeline(configuration, kNoSource, {&sink}, {});
  play(frames, pipeline);
  std::istringstream truth(read_shared(folder + "/truth.csv"));
  const Result result{drift_errors(sink.odometries, TrueTrajectory(truth), 10.0),
                      pipeline.vehicle(VehicleSignal::speed),
                      pipeline.vehicle(VehicleSignal::yaw_rate)};
  std::printf("%s %s: %d windows of 10 s, yaw %.3f deg, path %.3f %%\n", scene.name,
              with_vehicle ? "with the vehicle bus" : "radars alone", result.errors.windows,
              result.errors.yaw_deg, 100.0 * result.errors.path);
  return result;
}

void check_sound(const VehicleStatus& status) {
  CHECK(signal_state(status) == SignalState::ok);
  CHECK(status.odometry.times_lost + status.odometry.times_frozen +
            status.odometry.times_left_out ==
        0);
  CHECK(status.odometry.measurements_used > 300);
}

}  // namespace

TEST_CASE("Real drives: with speed and yaw rate of the car's bus, errors after 10 s") {
  // Settings on the first three, checked on the others.
  const std::vector<DriveOfCar> scenes = {{"scene-0061", "nuscenes-singapore"},
                                          {"scene-0103", "nuscenes-boston"},
                                          {"scene-1094", "nuscenes-singapore"},
                                          {"scene-0655", "nuscenes-boston"},
                                          {"scene-0796", "nuscenes-singapore"}};
  double yaw_deg = 0.0;
  double yaw_alone_deg = 0.0;
  double path = 0.0;
  for (const DriveOfCar& scene : scenes) {
    CAPTURE(scene.name);
    const Result alone = result_of(scene, false);
    const Result with = result_of(scene, true);
    CHECK(with.errors.yaw_deg < 0.4);  // Gyro and poses part by 0.3 degrees on 0796.
    check_sound(with.speed);
    check_sound(with.yaw_rate);
    CHECK(alone.speed.odometry.readings == 0);
    yaw_deg += with.errors.yaw_deg / static_cast<double>(scenes.size());
    yaw_alone_deg += alone.errors.yaw_deg / static_cast<double>(scenes.size());
    path += with.errors.path / static_cast<double>(scenes.size());
  }
  std::printf("mean of five drives with the vehicle bus: yaw %.3f deg, path %.3f %%\n", yaw_deg,
              100.0 * path);
  CHECK(yaw_deg <= 0.22);
  CHECK(yaw_deg < yaw_alone_deg);
  CHECK(path <= 0.0035);
}
