// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "cremed/estimator/scan/pose2.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Number of places where the Doppler of a scan agrees with a motion (`own`), and where it agrees
/// with the most frequent other speed (`rival`), unless clutter has as many. Targets near each
/// other are one place: a car is one or two places.
struct SpeedVotes {
  std::size_t own = 0;
  std::size_t rival = 0;
  std::size_t own_targets = 0;
  std::size_t rival_targets = 0;
  double rival_mps = 0.0;
  double own_mps = 0.0;   ///< Median speed of the votes for `own`.
  std::size_t abeam = 0;  ///< Targets (not places) abeam: no vote.

  [[nodiscard]] bool is_rival_slower() const { return std::abs(rival_mps) < std::abs(own_mps); }
};

/// Counts the votes of two speeds. In a traffic jam most targets may be on cars of nearly the same
/// speed as the vehicle. The radar then sees two rigid worlds, and a single scan cannot show which
/// of them is the road. All storage is inside the object.
class RivalSpeed {
 public:
  explicit RivalSpeed(const Pose2& vehicle_from_radar) : vehicle_from_radar_(vehicle_from_radar) {}

  /// `velocity` (m/s along x, m/s along y, rad/s): may be a mean over some time; `change_mps`
  /// bounds the difference of the speed at the scan to it. Targets abeam have no vote.
  SpeedVotes count(const TargetSet& targets, const Eigen::Vector3d& velocity, double change_mps);

 private:
  struct Vote {
    double speed_mps;
    double std_mps;
    std::uint16_t target;
  };
  using Votes = std::span<Vote>;

  Votes collect(const TargetSet& targets, const Eigen::Vector3d& velocity);
  /// Median of the votes near `speed_mps`: the speed at the scan.
  double median_near(Votes votes, double speed_mps, double change_mps);
  /// The largest group of votes that agree with each other. Sorts the votes.
  static Votes largest_group(Votes votes);
  /// Whether a group of `all`, both sorted, is larger than groups of clutter.
  static bool is_more_than_clutter(Votes group, Votes all);

  Pose2 vehicle_from_radar_;
  std::array<Vote, kMaxDetections> votes_;
  std::array<double, kMaxDetections> near_mps_;
};

/// Smallest |cos_bearing| of a target that observes the speed along x: 60 degrees off the direction
/// of travel, where the noise of Doppler is doubled.
inline constexpr double kMinForwardCosine = 0.5;

/// Speed along x by the Doppler of a static target, if the vehicle moves with `velocity` otherwise.
double speed_along_x_mps(const Target& target, const Eigen::Vector3d& velocity,
                         const Pose2& vehicle_from_radar);

}  // namespace cremed
