// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"
#include "cremed/estimator/fusion/state/pose_chain.hpp"
#include "cremed/estimator/motion/doppler_velocity.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Whether a vehicle that stood for a while starts, or what it sees departs: a train, a convoy, a
/// jam.
///
/// If a share q of the targets rests and the others depart with V, the fitted velocity is
/// (1 - q) V and the residuals have the variance q (1 - q) V^2 besides the noise. Their ratio tells
/// the share long before both worlds can be told apart target by target:
///
///     (residuals^2 - noise^2) / fitted^2 = q / (1 - q)
///
/// The noise is that of the targets while all rest. It is no start either if radars see different
/// worlds, or if the motion is sideways.
class ParkedVehicle {
 public:
  enum class Verdict : std::uint8_t {
    rests,       ///< Nothing departs. Radars outvoted by most of the targets are ignored.
    undecided,   ///< Something departs, too slowly to tell.
    two_worlds,  ///< Something departs and something rests.
    started,     ///< All departs as one world.
  };

  /// Uses the mounts of `state`, which must outlive this object.
  explicit ParkedVehicle(const OdometryState& state) : state_(state), looks_(state.radars()) {}

  void clear();
  /// The newest output, before widen().
  void add_output(const Odometry& odometry);
  /// A parked vehicle may move as estimated or not at all: adds the way since it was parked, and
  /// the velocity, to the standard deviations.
  void widen(Odometry& odometry) const;
  /// The way (x, y, yaw) since the start that it seemed to go while parked: returned once, after it
  /// has left; otherwise zero.
  Eigen::Vector3d take_way();
  /// The vehicle stood for kParkedUs, at the start too, and has not started since.
  [[nodiscard]] bool is_parked() const { return is_parked_; }
  /// The last verdict.
  [[nodiscard]] Verdict verdict() const { return is_parked_ ? verdict_ : Verdict::started; }
  /// Something departs, and it is not known whether the vehicle does.
  [[nodiscard]] bool is_in_doubt() const { return is_parked_ && verdict_ != Verdict::rests; }
  /// Judges by a scan and the last scans of the other radars. A start ends is_parked(). Returns the
  /// verdict; two_worlds for a radar whose targets are outvoted by those of the others.
  Verdict judge(std::size_t radar, const TargetSet& targets, const DopplerVelocity& velocity,
                std::int64_t stamp_us);

 private:
  static constexpr std::int64_t kParkedUs = 1'000'000;

  /// q / (1 - q) = rest / departing.
  struct Share {
    double rest = 0.0;
    double departing = 0.0;
    double noise = 0.0;     // Was subtracted from `rest`.
    double variance = 0.0;  // Of `noise`.

    void add(const Share& other);
    [[nodiscard]] double value() const { return rest / departing; }
    [[nodiscard]] double error() const;
  };
  /// Sums over the last scans of a radar, with weights that decay.
  struct Look {
    std::int64_t stamp_us = 0;
    double scans = 0.0;
    Eigen::Vector2d sum_mps = Eigen::Vector2d::Zero();
    Eigen::Vector2d sum_variance = Eigen::Vector2d::Zero();
    double targets = 0.0;
    double missed = 0.0;    ///< Squares of residuals.
    double expected = 0.0;  ///< Squares of Doppler by the fitted velocity.
    double noise = 0.0;     ///< Variance of a target's Doppler, learned at rest.
    bool counts = false;    ///< The radar is recent, and the others do not outvote it.

    [[nodiscard]] Eigen::Vector2d mean_mps() const { return sum_mps / scans; }
    [[nodiscard]] Eigen::Array2d std_mps() const { return sum_variance.array().sqrt() / scans; }
    void add(const TargetSet& seen, const DopplerVelocity& velocity, std::int64_t now_us);
    void learn_noise(const TargetSet& seen);
    [[nodiscard]] bool departs() const;
    [[nodiscard]] bool rests_beside(const Eigen::Vector2d& departing_mps, double sigmas) const;
    [[nodiscard]] Share share() const;
  };

  void leave();
  void leave_out_odd(std::int64_t stamp_us);
  [[nodiscard]] Eigen::Vector2d fastest_mps() const;
  [[nodiscard]] Verdict judge_all() const;
  [[nodiscard]] bool is_sideways(std::size_t radar) const;

  const OdometryState& state_;
  std::vector<Look> looks_;
  Verdict verdict_ = Verdict::rests;
  bool is_parked_ = false;
  bool may_rest_ = false;     // It stands still, or the start is at rest.
  std::int64_t rest_us_ = 0;  // Since when.
  // Pose since the anchor when it was parked.
  std::int64_t anchor_us_ = 0;
  Eigen::Vector3d parked_pose_ = Eigen::Vector3d::Zero();
  // Poses since the start when it was parked, and when it last stood; take_way().
  Eigen::Vector3d parked_odom_pose_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rest_odom_pose_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d way_ = Eigen::Vector3d::Zero();
};

}  // namespace cremed
