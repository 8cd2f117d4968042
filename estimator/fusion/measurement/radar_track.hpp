// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "cremed/estimator/fusion/measurement/doppler_excess.hpp"
#include "cremed/estimator/fusion/state/odometry_options.hpp"
#include "cremed/estimator/motion/doppler_velocity.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// The sensor's velocity by a scan's Doppler.
struct ScanVelocity {
  DopplerVelocity velocity;
  /// More than half of the targets are static at this velocity. Otherwise the targets that agree
  /// may be moving.
  bool is_clear = false;
  /// Of residuals, beyond the noise (m^2/s^2): DopplerExcess.
  double excess_m2ps2 = 0.0;
};

/// The scans of one radar: their order, and their velocity by Doppler.
class RadarTrack {
 public:
  explicit RadarTrack(const OdometryOptions& options);

  void clear();

  /// Begins a scan; returns the time since the previous one, or 0.
  double begin(std::int64_t stamp_us);
  [[nodiscard]] bool is_in_order(std::int64_t stamp_us) const {
    return !stamp_us_ || stamp_us > *stamp_us_;
  }

  /// `expected`: velocity of the sensor, if known. Adapts the standard deviation of Doppler to the
  /// residuals.
  std::optional<ScanVelocity> velocity(const TargetSet& targets,
                                       const std::optional<Eigen::Vector2d>& expected);

 private:
  const OdometryOptions& options_;
  DopplerVelocityEstimator doppler_;
  std::optional<std::int64_t> stamp_us_;  // Of the last scan.
  double since_last_s_ = 0.0;
  double doppler_std_mps_ = 0.0;
  DopplerExcess excess_;
};

}  // namespace cremed
