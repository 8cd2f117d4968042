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
/// Compares every 0.2 s, with the targets that are at rest by Doppler. A contradiction is another
/// speed, more than 2 m/s from Doppler's, of whose votes Doppler's has less than 0.6, and two
/// standard deviations of their numbers fewer. Stuck Doppler has 0.3 to 0.6 of them; healthy drives
/// 0.66 at least where the difference is that large (RadarScenes 105 and nuScenes, 20588
/// comparisons at random phases; by number alone up to 3 standard deviations, since posts of guard
/// rails repeat). With half of their targets or less by chance: then for another speed each time.
/// Contradictions by one speed count up, agreements count down; the doubt begins at
/// kMaxContradictions and ends at 0, or with a step of the Doppler that no vehicle can make.
/// Detection takes 1 s of driving.
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
  TargetSet current_;    // Fixed places.
  TargetSet reference_;  // The same of an earlier scan.
  std::int64_t reference_us_ = 0;
  double reference_mps_ = 0.0;
  std::int64_t last_us_ = 0;  // Of the newest speed by Doppler.
  double last_mps_ = 0.0;
  std::int64_t verdict_us_ = 0;
  int contradictions_ = 0;
  double other_mps_ = 0.0;  // That of the last one.
  bool has_reference_ = false;
  bool has_verdict_ = false;
  bool is_contradicted_ = false;
};

}  // namespace cremed
