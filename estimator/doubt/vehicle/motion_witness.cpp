// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/motion_witness.hpp"

#include <algorithm>
#include <cmath>

#include "cremed/estimator/motion/vehicle_limits.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

constexpr double kWitnessSigmas = 5.0;  // False-alarm rate: 1 in two million.
constexpr double kMaxAgeS = 0.3;        // Braking changes the speed by up to 3 m/s.

/// Mean time between a point in time and an interval of length `span_s` whose middle is
/// `distance_s` away.
double mean_distance_s(double distance_s, double span_s) {
  const double half_s = 0.5 * span_s;
  return distance_s >= half_s ? distance_s
                              : (half_s * half_s + distance_s * distance_s) / (2.0 * half_s);
}

}  // namespace

bool contradicts(const Odometry& known, const EgoMotion& motion) {
  const double span_s = seconds_between(motion.utime_start_us, motion.utime_us);
  const double since_s = seconds_between(known.utime_us, motion.utime_us);
  if (!motion.has_estimate() || std::abs(since_s) > kMaxAgeS) {
    return false;
  }
  const double time_s = mean_distance_s(std::abs(since_s - 0.5 * span_s), span_s);
  const auto differs = [&](int axis, double possible_change) {
    const double variance =
        motion.covariance(axis, axis) / (span_s * span_s) + known.twist_covariance(axis, axis);
    return std::abs(motion.motion(axis) / span_s - known.twist(axis)) >
           possible_change * time_s + kWitnessSigmas * std::sqrt(variance);
  };
  return differs(0, kMaxAccelerationMps2) || differs(2, kMaxYawAccelerationRadps2);
}

EgoMotion withdrawn(EgoMotion motion) {
  motion.status = MotionStatus::ambiguous;
  motion.motion.setConstant(EgoMotion::kNan);
  motion.covariance.setConstant(EgoMotion::kNan);
  motion.doppler_nis = EgoMotion::kNan;
  return motion;
}

}  // namespace cremed
