// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "cremed/estimator/motion/rival_speed.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Whether the Doppler of one radar's scans shows two worlds, the road and what drives as we do,
/// and nothing tells which is which. The motion before tells, if it leads to one speed and not to
/// the other. Without one, what seems to be the road must be in more places than a truck, if two
/// places speak against it. Once in doubt, a smaller rival keeps it up, and it takes ten scans
/// without any to end it.
class TwoWorlds {
 public:
  explicit TwoWorlds(const Pose2& vehicle_from_radar) : rival_speed_(vehicle_from_radar) {}

  /// Looks at a scan. `velocity`, `change_mps`: see RivalSpeed::count. `continues(speed_mps)`:
  /// whether the vehicle may drive so, given its motion before. `is_start`: nothing is known of it.
  template <typename Continues>
  bool look(const TargetSet& targets, const Eigen::Vector3d& velocity, double change_mps,
            bool is_start, Continues continues) {
    const SpeedVotes votes = rival_speed_.count(targets, velocity, change_mps);
    const bool is_open =
        (is_start && votes.own + votes.abeam < kMinRoadPlaces && votes.rival >= kMinRivalPlaces) ||
        (is_rival(votes) && (continues(votes.rival_mps) || !continues(velocity.x())));
    doubtful_scans_ = is_open ? kClearScans : doubtful_scans_ - (is_in_doubt() ? 1 : 0);
    return is_in_doubt();
  }
  [[nodiscard]] bool is_in_doubt() const { return doubtful_scans_ > 0; }

 private:
  static constexpr int kClearScans = 10;  ///< 0.75 s of an ARS408.
  /// The rear of a truck and its sides are three to five places of 3 m.
  static constexpr std::size_t kMinRoadPlaces = 6;
  /// One place may be another car.
  static constexpr std::size_t kMinRivalPlaces = 2;

  [[nodiscard]] bool is_rival(const SpeedVotes& votes) const;

  RivalSpeed rival_speed_;
  int doubtful_scans_ = 0;
};

}  // namespace cremed
