// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Votes for speeds by the positions of targets.
struct SpeedSupport {
  double best_mps = 0.0;     ///< The speed with most votes, to kStepMps.
  double best_votes = 0.0;   ///< Its votes.
  double given_votes = 0.0;  ///< Votes of the given speed.
  /// Bound that chance votes rarely exceed, by the mean over all speeds at the best yaw rate: walls
  /// give many chance votes, but at one yaw rate only.
  double max_chance_votes = 0.0;
};

/// Coarse forward speed by the positions of targets alone, without Doppler, association or start
/// value: a Hough transform over speed and yaw rate. Two scans are compared. For each yaw rate,
/// each pair of a target and an earlier target straight ahead of or behind it votes for the speed
/// between them. Votes of static targets add up at one speed; votes of moving targets and chance
/// pairs spread over all speeds. The votes of the last kPairs comparisons are added; speed and yaw
/// rate change by about one step meanwhile.
class PositionSpeed {
 public:
  static constexpr double kStepMps = 1.0;
  /// Interval between compared scans: long enough for a motion above the noise of positions (0.2 m
  /// in 0.2 s at kStepMps), short enough for targets to stay in view.
  static constexpr double kMinIntervalS = 0.2;
  static constexpr double kMaxIntervalS = 1.0;

  /// Compares two scans, `current` taken `dt_s` after `previous`, with the speed `given_mps` (by
  /// Doppler). None if no speed has more votes than chance.
  std::optional<SpeedSupport> compare(const TargetSet& previous, const TargetSet& current,
                                      double dt_s, double given_mps);
  /// Removes all votes.
  void clear() { pairs_.fill({}); }

 private:
  static constexpr double kMinSpeedMps = -12.0;
  static constexpr std::size_t kSteps = 64;
  static constexpr std::size_t kYawRates = 13;  ///< Odd: zero is the middle one.
  static constexpr std::size_t kPairs = 3;
  using Votes = std::array<int, kSteps>;
  struct Pair {
    std::array<Votes, kYawRates> votes{};
    std::size_t given_step = 0;  ///< Step of the given speed.
  };

  /// A target of the earlier scan.
  struct Place {
    double x_m;
    double y_m;
    double side_variance_m2;
  };
  using Places = std::span<const Place>;

  Places sort_by_side(const TargetSet& previous);
  static void count(Places previous, const TargetSet& current, double dt_s, double yaw_rate_radps,
                    Votes& votes);
  [[nodiscard]] SpeedSupport sum_up() const;

  /// Bounds the work. An ARS408 sends its nearest targets first, which are the most precise.
  static constexpr std::size_t kMaxTargets = 96;

  std::array<Place, kMaxTargets> places_;
  std::array<Pair, kPairs> pairs_{};
  std::size_t newest_ = 0;
};

}  // namespace cremed
