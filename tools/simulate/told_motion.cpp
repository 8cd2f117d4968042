// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulate/told_motion.hpp"

#include <cmath>

#include "cremed/estimator/cost/driving_share.hpp"
#include "cremed/estimator/scan/degrees.hpp"

namespace cremed {
namespace {

/// A value is measured and sent every 10 ms and is 10 ms old on arrival, so 10 to 20 ms old in use.
constexpr double kPeriodS = 0.01;
constexpr double kDelayS = 0.01;

/// From wheel encoders and gyro of a real car compared with each other and with its map-based pose
/// (nuScenes).
constexpr double kSpeedStdMps = 0.02;
constexpr double kYawRateStdRadps = 0.15 * kRadPerDeg;

/// Resolution of 0x300 and 0x301.
constexpr double kSpeedStepMps = 0.02;
constexpr double kYawRateStepRadps = 0.01 * kRadPerDeg;

double on_grid(double value, double step) { return step * std::round(value / step); }

}  // namespace

double static_across_mps(const ToldMotion& told, const Pose2& vehicle_from_radar, double range_m,
                         double azimuth_rad) {
  const Pose2& mount = vehicle_from_radar;
  const double radar_x_mps = told.speed_mps - told.yaw_rate_radps * mount.y_m;
  const double radar_y_mps = told.yaw_rate_radps * mount.x_m;
  const double bearing_rad = azimuth_rad + mount.yaw_rad;
  return radar_x_mps * std::sin(bearing_rad) - radar_y_mps * std::cos(bearing_rad) -
         told.yaw_rate_radps * range_m;
}

VehicleBus::VehicleBus(const VehicleCourse& course, Random speed, Random yaw_rate)
    : course_(course), speed_(kSpeedStdMps, speed), yaw_rate_(kYawRateStdRadps, yaw_rate) {}

ToldMotion VehicleBus::at(double time_s) const {
  const double measured_s = kPeriodS * std::floor(time_s / kPeriodS) - kDelayS;
  const VehicleState state = course_.at(measured_s);
  const double rolling = driving_share(state.speed_mps);
  return {on_grid(state.speed_mps + rolling * speed_.at(measured_s), kSpeedStepMps),
          on_grid(state.yaw_rate_radps + rolling * yaw_rate_.at(measured_s), kYawRateStepRadps)};
}

}  // namespace cremed
