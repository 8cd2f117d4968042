// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/estimator/scan/pose2.hpp"
#include "tools/simulate/random.hpp"
#include "tools/simulate/slow_error.hpp"
#include "tools/simulate/vehicle_course.hpp"

namespace cremed {

/// Motion that the vehicle's bus sends to a sensor (0x300, 0x301). Without it the sensor assumes
/// standstill.
struct ToldMotion {
  double speed_mps = 0.0;       ///< Of the rear axle along x.
  double yaw_rate_radps = 0.0;  ///< Positive to the left.
};

/// Velocity across the line of sight, positive to the left, of a static target at this place in the
/// frame of a radar on a vehicle with this motion:
///     v_t - w r,   v_t = -(v + w x l) . t
/// with the yaw rate w, the radar's lever arm l and t to the left of the line of sight.
double static_across_mps(const ToldMotion& told, const Pose2& vehicle_from_radar, double range_m,
                         double azimuth_rad);

/// Wheel encoders and gyro of the vehicle, as sent on its bus.
class VehicleBus {
 public:
  VehicleBus(const VehicleCourse& course, Random speed, Random yaw_rate);

  /// The last values received by then.
  [[nodiscard]] ToldMotion at(double time_s) const;

 private:
  const VehicleCourse& course_;
  SlowError speed_;
  SlowError yaw_rate_;
};

}  // namespace cremed
