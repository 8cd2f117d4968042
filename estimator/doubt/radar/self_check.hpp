// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "cremed/estimator/doubt/radar/doppler_scale.hpp"
#include "cremed/estimator/doubt/radar/nis_mean.hpp"
#include "cremed/estimator/doubt/radar/repeated_targets.hpp"
#include "cremed/estimator/doubt/radar/speed_check.hpp"
#include "cremed/estimator/motion/ego_motion_estimator.hpp"

namespace cremed {

/// Reasons to doubt a radar's covariance, as bits.
enum Doubt : std::uint32_t {
  registration_contradicts_doppler = 1U << 0U,  ///< Wrong mount, Doppler sign or noise.
  motions_contradict_each_other = 1U << 1U,     ///< Changes beyond a vehicle's limits.
  other_radars_contradict = 1U << 2U,           ///< OdometryFilter leaves the radar out.
  covariance_too_large = 1U << 3U,              ///< Configured noise is far too high.
  positions_contradict_speed = 1U << 4U,        ///< Wrong Doppler or rate of the stamps.
  stamps_run_ahead = 1U << 5U,                  ///< Ahead of those of all other buses.
  stamps_run_behind = 1U << 6U,                 ///< Behind those of all other buses.
};

/// Compares independent estimates of one radar while driving. No ground truth is needed: if
/// covariances are true, the NIS of the difference of two independent estimates is 1 per degree of
/// freedom on average on any drive.
class SelfCheck {
 public:
  explicit SelfCheck(const EgoMotionOptions& options)
      : options_(options.registration),
        looks_across_(cremed::looks_across(options.vehicle_from_radar)),
        scale_(options.vehicle_from_radar) {}

  /// A motion, and the targets of the scan at its end.
  void add(const EgoMotion& motion, const TargetSet& targets);
  /// To be called when the clock of the stamps was set, and instead of add() for a scan that tells
  /// nothing of the radar.
  void forget();

  /// Positions contradict the speed or scale of Doppler.
  [[nodiscard]] bool contradicts_speed() const {
    return speed_.is_contradicted() || scale_.is_wrong();
  }
  /// Factor that corrects Doppler then, if it is known.
  [[nodiscard]] std::optional<double> speed_correction() const {
    return scale_.is_wrong() ? std::optional(scale_.correction()) : std::nullopt;
  }
  /// Whether positions contradict it is not known yet.
  [[nodiscard]] bool is_speed_undecided() const { return scale_.is_open(); }
  /// Discards this finding: other radars confirm the speed by Doppler.
  void acquit_speed();
  /// Discards all findings: its Doppler is corrected otherwise from now on.
  void begin_anew();

  /// NIS of positions against Doppler (EgoMotion::doppler_nis).
  [[nodiscard]] const NisMean& doppler() const { return doppler_; }
  /// NIS of a motion's velocity against that of the previous motion, with the accelerations of
  /// SharedErrorOptions.
  [[nodiscard]] const NisMean& next() const { return next_; }

  /// Check of the Doppler speed by positions.
  [[nodiscard]] const SpeedCheck& speed() const { return speed_; }
  /// Check of the scale of Doppler by positions.
  [[nodiscard]] const DopplerScale& scale() const { return scale_; }

  /// The last scan repeats the one before: it is no measurement.
  [[nodiscard]] bool is_repeated() const { return repeated_.is_repeated(); }

  /// Factor on the covariance of the motions of a radar that looks sideways: the larger of
  /// doppler() and next(), at least 1. Such a radar registers reflections on passed objects, which
  /// move along with the vehicle: its ANEES is 2 to 30 on nuScenes, half of it due to a tenth of
  /// its motions. 1 for other radars, which are doubted instead.
  [[nodiscard]] double covariance_factor() const;

  /// Doubts by this radar's own estimates.
  [[nodiscard]] std::uint32_t doubts() const;
  /// Whether there is no doubt but covariance_too_large.
  [[nodiscard]] bool is_trusted() const { return (doubts() & ~covariance_too_large) == 0; }

 private:
  void compare_with_last(const EgoMotion& motion);

  RegistrationOptions options_;
  bool looks_across_;
  NisMean doppler_;
  NisMean next_;
  SpeedCheck speed_;
  DopplerScale scale_;
  RepeatedTargets repeated_;
  double yaw_rate_radps_ = 0.0;
  EgoMotion last_;
};

}  // namespace cremed
