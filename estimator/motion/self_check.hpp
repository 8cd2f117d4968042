// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "cremed/estimator/motion/ego_motion_estimator.hpp"
#include "cremed/estimator/motion/innovation_mean.hpp"
#include "cremed/estimator/motion/speed_check.hpp"

namespace cremed {

/// Why a radar's covariance is not to be believed; bits.
enum Doubt : std::uint32_t {
  registration_contradicts_doppler = 1U << 0U,  ///< Mount, sign of Doppler or noise is wrong.
  motions_contradict_each_other = 1U << 1U,     ///< It jumps more than a vehicle can.
  other_radars_contradict = 1U << 2U,           ///< OdometryFilter leaves it out.
  covariance_too_large = 1U << 3U,              ///< Noise is set far too high.
  positions_contradict_speed = 1U << 4U,        ///< Doppler or the stamps' pace is wrong.
};

/// Compares, while driving, what a radar says with what it says itself in another way. No truth is
/// needed: if covariances are right, the difference of two independent estimates over its own
/// covariance is 1 on average, whatever the drive.
class SelfCheck {
 public:
  explicit SelfCheck(const RegistrationOptions& options) : options_(options) {}

  /// A motion, and the targets of the scan at its end.
  void add(const EgoMotion& motion, const TargetSet& targets);
  /// The clock of the stamps was set.
  void forget();

  /// The targets found again against their Doppler (EgoMotion::doppler_innovation).
  [[nodiscard]] const InnovationMean& doppler() const { return doppler_; }
  /// A motion's velocity against that of the one before it, which differ by what the vehicle may
  /// accelerate (SharedErrorOptions) as well.
  [[nodiscard]] const InnovationMean& next() const { return next_; }

  /// Its Doppler against the speed by its positions.
  [[nodiscard]] const SpeedCheck& speed() const { return speed_; }

  /// Doubts in this radar by itself.
  [[nodiscard]] std::uint32_t doubts() const;
  /// Whether none of them says that its errors are greater than its covariance.
  [[nodiscard]] bool is_believable() const { return (doubts() & ~covariance_too_large) == 0; }

 private:
  void compare_with_last(const EgoMotion& motion);

  RegistrationOptions options_;
  InnovationMean doppler_;
  InnovationMean next_;
  SpeedCheck speed_;
  EgoMotion last_;
};

}  // namespace cremed
