// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "cremed/estimator/doubt/radar/position_speed.hpp"
#include "cremed/estimator/motion/doppler_velocity.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Checks a radar's Doppler speed against the speed by its positions. It detects Doppler that is
/// stuck or over ground instead of relative to the sensor, and stamps that do not run at the rate
/// of time.
///
/// Compares two scans every 0.2 s by their targets that are at rest by Doppler (PositionSpeed). It
/// is a contradiction if the best speed is more than 2 m/s from Doppler's, and Doppler's has less
/// than 0.6 of its votes and fewer by two standard deviations of the counts. With Doppler stuck the
/// share is 0.3 to 0.6. On healthy drives it is 0.66 at least where the speeds differ by that much
/// (RadarScenes 105 and nuScenes, 20588 comparisons at random phases); the counts alone differ by
/// up to 3 standard deviations, since posts of guard rails repeat. With half of the targets or less
/// healthy drives contradict by chance, but by another speed each time.
///
/// Contradictions by one speed count up, agreements count down; the doubt begins at
/// kMaxContradictions and ends at 0, or with a step of Doppler that no vehicle can make. Detection
/// takes 1 s of driving.
class SpeedCheck {
 public:
  /// Adds the targets of the next scan.
  void add(const TargetSet& targets, std::int64_t stamp_us);
  /// To be called when the clock of the stamps was set.
  void forget();

  [[nodiscard]] bool is_contradicted() const { return is_contradicted_; }
  /// Whether a comparison was possible in the last kVerdictValidS.
  [[nodiscard]] bool is_checked() const { return has_verdict_; }

 private:
  static constexpr int kMaxContradictions = 3;
  static constexpr double kVerdictValidS = 5.0;

  [[nodiscard]] std::optional<double> take(const TargetSet& targets);
  void judge(const SpeedSupport& support, double doppler_mps);

  PositionSpeed positions_;
  DopplerVelocityEstimator doppler_;
  TargetSet current_;    // Targets at rest of the newest scan.
  TargetSet reference_;  // Targets at rest of the earlier scan.
  std::int64_t reference_us_ = 0;
  double reference_mps_ = 0.0;
  std::int64_t last_us_ = 0;  // Stamp of the newest speed by Doppler.
  double last_mps_ = 0.0;
  std::int64_t verdict_us_ = 0;
  int contradictions_ = 0;
  double other_mps_ = 0.0;  // Best speed of the last contradiction.
  bool has_reference_ = false;
  bool has_verdict_ = false;
  bool is_contradicted_ = false;
};

}  // namespace cremed
