// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "cremed/estimator/doubt/scan/rival_speed.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Detects that the Doppler of one radar shows two rigid worlds, the road and vehicles that move
/// along, and that it is open which is the road. A rival is another speed with at least 5 places, a
/// quarter of those of the estimated speed, and 0.15 of its targets if it is slower. When a scan is
/// in doubt, by what is known before it:
///
/// - motion: a rival, unless the vehicle can continue at the estimated speed, not at the rival's;
/// - fault: each rival; or a speed of two places, if the estimated one has fewer than six (targets
///   abeam included), as a truck has;
/// - first_scans: as with motion; or a slower rival (traffic may pass a parked vehicle); or a speed
///   of two places, if the estimated one has fewer than six (with those abeam), or fewer than it;
/// - first_scans_lone_side_radar: as with first_scans; or the estimated speed had fewer than six
///   places in one of the last ten scans, those abeam not counted.
///
/// A doubt ends ten scans after the last such scan; a rival of three places and a tenth of those of
/// the estimated speed maintains it.
class TwoWorlds {
 public:
  /// What is known of the motion before a scan.
  enum class Before : std::uint8_t {
    first_scans,
    /// The only radar looks sideways: along the way, where Doppler shows the speed, it may see
    /// nothing but a vehicle beside.
    first_scans_lone_side_radar,
    fault,  ///< The odometry was lost: positions have to confirm the next start.
    motion,
  };

  explicit TwoWorlds(const Pose2& vehicle_from_radar) : rival_speed_(vehicle_from_radar) {}

  /// Checks a scan; true if in doubt. `velocity`, `change_mps`: see RivalSpeed::count.
  /// `continues(speed_mps)`: whether the vehicle can have this speed after its previous motion.
  template <typename Continues>
  bool check(const TargetSet& targets, const Eigen::Vector3d& velocity, double change_mps,
             Before before, Continues continues) {
    const SpeedVotes votes = rival_speed_.count(targets, velocity, change_mps);
    const bool is_first_start =
        before == Before::first_scans || before == Before::first_scans_lone_side_radar;
    const bool is_possible = before == Before::fault || continues(votes.rival_mps) ||
                             !continues(velocity.x()) ||
                             (is_first_start && votes.is_rival_slower());
    const bool is_open =
        (before != Before::motion && votes.rival >= kMinRivalPlaces &&
         votes.own + votes.abeam < kMinRoadPlaces) ||
        (is_first_start && votes.rival >= kMinRivalPlaces && votes.rival > votes.own) ||
        (is_rival(votes) && is_possible);
    doubtful_scans_ = is_open ? kClearScans : doubtful_scans_ - (is_in_doubt() ? 1 : 0);
    const bool may_be_a_vehicle =
        before == Before::first_scans_lone_side_radar && was_few(votes.own < kMinRoadPlaces);
    return is_in_doubt() || may_be_a_vehicle;
  }
  [[nodiscard]] bool is_in_doubt() const { return doubtful_scans_ > 0; }

 private:
  static constexpr int kClearScans = 10;  ///< 0.75 s of an ARS408.
  /// The rear of a truck and its sides are three to five places of 3 m.
  static constexpr std::size_t kMinRoadPlaces = 6;
  /// One place may be another car.
  static constexpr std::size_t kMinRivalPlaces = 2;

  /// Whether one of the last kClearScans scans had too few places.
  bool was_few(bool is_few) {
    few_scans_ = is_few ? kClearScans : std::max(0, few_scans_ - 1);
    return few_scans_ > 0;
  }
  [[nodiscard]] bool is_rival(const SpeedVotes& votes) const;

  RivalSpeed rival_speed_;
  int doubtful_scans_ = 0;
  int few_scans_ = 0;
};

}  // namespace cremed
