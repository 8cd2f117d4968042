// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "cremed/estimator/scan/pose2.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// In how many places the Doppler of a scan agrees with a motion, and in how many with the other
/// speed that most of the rest agree on. Targets near each other are one place: a car is one or
/// two, however many targets it shows.
struct SpeedVotes {
  std::size_t own = 0;
  std::size_t rival = 0;
  double rival_mps = 0.0;
  std::size_t abeam = 0;  ///< Targets, not places, that have no vote.
};

/// In a jam most targets may be on cars that drive as we do. The radar then sees two worlds, each
/// at rest in itself, and nothing in one scan says which of them is the road. This counts both. All
/// storage is inside the object.
class RivalSpeed {
 public:
  explicit RivalSpeed(const Pose2& vehicle_from_radar) : vehicle_from_radar_(vehicle_from_radar) {}

  /// `velocity`: along x, along y, of the yaw; the mean of a time at whose end the speed along x
  /// may be another by `change_mps`. Targets abeam have no vote.
  SpeedVotes count(const TargetSet& targets, const Eigen::Vector3d& velocity, double change_mps);

 private:
  struct Vote {
    double speed_mps;
    double std_mps;
    std::uint16_t target;
  };
  using Votes = std::span<Vote>;

  Votes collect(const TargetSet& targets, const Eigen::Vector3d& velocity);
  /// The speed at the moment of the scan.
  double median_near(Votes votes, double speed_mps, double change_mps);
  /// The most of these votes that agree with each other. Sorts them.
  static Votes largest_group(Votes votes);

  Pose2 vehicle_from_radar_;
  std::array<Vote, kMaxDetections> votes_;
  std::array<double, kMaxDetections> near_mps_;
};

/// Least |cos_bearing| of a target that tells the speed along x: 60 degrees off the way, where the
/// noise of Doppler counts twice.
inline constexpr double kMinForwardCosine = 0.5;

/// Speed along x that a target speaks for if it stands.
double speed_along_x_mps(const Target& target, const Eigen::Vector3d& velocity,
                         const Pose2& vehicle_from_radar);

}  // namespace cremed
