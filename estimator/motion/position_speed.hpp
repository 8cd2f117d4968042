// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// How often the targets of a scan are found again at a speed.
struct SpeedSupport {
  double best_mps = 0.0;   ///< The speed with most votes, to kStepMps.
  double best = 0.0;       ///< Its votes.
  double asked = 0.0;      ///< Those of the speed that was asked about.
  double by_chance = 0.0;  ///< What chance alone hardly exceeds anywhere.
};

/// The forward speed that positions of scans tell by themselves, roughly but without any start: no
/// Doppler, no partners. Two scans are compared: each pair of a target and one of the earlier scan
/// that lies straight ahead of or behind it, once the vehicle has turned at one of a few yaw rates,
/// votes for the speed that leads from one to the other. Static targets agree on one speed (a Hough
/// transform); what drives, and chance, spreads over all. The votes of the last kPairs such
/// comparisons are added up: speed and yaw rate of a vehicle change by about a step meanwhile.
class PositionSpeed {
 public:
  static constexpr double kStepMps = 1.0;
  /// Between two scans that are compared: long enough that a target moves by more than its position
  /// is uncertain (0.2 m in 0.2 s at kStepMps), short enough that it is still seen.
  static constexpr double kMinIntervalS = 0.2;
  static constexpr double kMaxIntervalS = 1.0;

  /// Positions in `current`, `dt_s` after `previous`; `asked_mps` is what Doppler says. Nothing
  /// where no speed stands out from chance: there is nothing to compare with.
  std::optional<SpeedSupport> compare(const TargetSet& previous, const TargetSet& current,
                                      double dt_s, double asked_mps);
  /// What was compared so far says nothing of what comes.
  void clear() { pairs_.fill({}); }

 private:
  static constexpr double kLeastMps = -12.0;
  static constexpr std::size_t kSteps = 64;
  static constexpr std::size_t kYawRates = 13;  ///< An odd number of them.
  static constexpr std::size_t kPairs = 3;
  using Votes = std::array<int, kSteps>;
  struct Pair {
    std::array<Votes, kYawRates> votes{};
    std::size_t asked = 0;  ///< Step of the speed that was asked about.
  };

  static void count(const TargetSet& previous, const TargetSet& current, double dt_s,
                    double yaw_rate_radps, Votes& votes);
  [[nodiscard]] SpeedSupport sum_up() const;

  std::array<Pair, kPairs> pairs_{};
  std::size_t newest_ = 0;
};

}  // namespace cremed
