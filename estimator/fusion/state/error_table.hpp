// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>
#include <vector>

#include "cremed/can_decoders/vehicle_reading.hpp"
#include "cremed/estimator/fusion/state/odometry_options.hpp"
#include "cremed/estimator/scan/pose2.hpp"

namespace cremed {

/// An error in the state of the odometry filter: a row of the table of errors. Start, propagation
/// and updates know no more of an error than its row, so that a new one takes an index
/// (state_layout), a row, and its coefficients in the measurements.
struct StateError {
  /// What resets it.
  enum class Reset {
    never,
    doubt,  ///< Doubt about its radar: to the variance of its prior, around the estimate.
    scene,  ///< Doubt or a restart: to its prior, since it passes within seconds.
  };
  /// Measurements as bits.
  static constexpr unsigned kNone = 0;
  static constexpr unsigned kVelocities = 1U << 0U;  ///< By Doppler, or of the vehicle's bus.
  static constexpr unsigned kX = 1U << 1U;           ///< x by positions.
  static constexpr unsigned kYAndYaw = 1U << 2U;     ///< y and yaw by positions.
  static constexpr unsigned kAtRest = 1U << 3U;      ///< All while the vehicle stands.
  static constexpr unsigned kPositions = kX | kYAndYaw;
  static constexpr unsigned kAllButX = kVelocities | kYAndYaw | kAtRest;
  static constexpr unsigned kAll = kAllButX | kX;

  std::string_view name;
  int state;  ///< Index.
  ErrorProcess process;
  Reset reset;
  /// Measurements that do not change its mean: for them it is a consider parameter
  /// (Schmidt-Kalman).
  unsigned considered_by = kNone;
  /// Share of the forward velocity that is across the axis of its radar, where azimuths measure it.
  double across = 0.0;

  /// Standard deviation of the process at this motion; at rest that of the prior.
  [[nodiscard]] double std_at(double speed_mps, double yaw_rate_radps) const;
};

/// The rows of the vehicle's errors, which MotionStep moves, and of those common to all radars.
std::vector<StateError> common_errors(const OdometryOptions& options);
/// The rows of one radar, whose states begin at `first`.
std::vector<StateError> radar_errors(const OdometryOptions& options, const Pose2& mount, int first);
/// The rows of a signal of the vehicle's bus; the states of both signals begin at `first`.
std::vector<StateError> signal_errors(const VehicleOptions& options, VehicleSignal signal,
                                      int first);

}  // namespace cremed
