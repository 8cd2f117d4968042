// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "cremed/estimator/doubt/vehicle/filter_condition.hpp"
#include "cremed/estimator/doubt/vehicle/motion_sums.hpp"
#include "cremed/estimator/doubt/vehicle/radar_consensus.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"

namespace cremed {

/// If a majority of radars contradicts the filter and agrees with each other, the velocity of the
/// state is reset to theirs, but not:
/// - a change of speed that no vehicle can make, by all radars or by the only one ahead;
/// - later velocities close to it;
/// - a majority that its own positions contradict.
/// The filter is then in doubt and later lost, and positions have to confirm the next start.
class MajorityFollower {
 public:
  /// The arguments must outlive this object.
  MajorityFollower(OdometryState& state, RadarConsensus& consensus, FilterCondition& condition)
      : state_(state), consensus_(consensus), condition_(condition) {}

  void clear() { step_.reset(); }
  /// Notes a change of the speed by all radars, or by the only one ahead, that no vehicle can make.
  /// `possible_change_mps`: largest change since the last scan that was used.
  void note_step(double change_mps, double possible_change_mps);
  /// Notes a jump (SpeedJump) of the only radar ahead. False if it takes back the last step.
  bool note_jump(double change_mps);
  /// Returns the change of (v, w) if the majority is followed. `majority`:
  /// RadarConsensus::contradicting_majority.
  std::optional<Eigen::Vector2d> follow(const MotionSums& majority, std::int64_t stamp_us,
                                        double possible_change_mps);
  /// Such a step was noted, and no scan was used since.
  [[nodiscard]] bool has_stepped() const { return step_ && step_->used_us == condition_.used_us(); }
  /// Its change of the speed.
  [[nodiscard]] std::optional<double> step_mps() const {
    return has_stepped() ? std::optional(step_->mps) : std::nullopt;
  }
  /// After such a step: whether a radar's velocity is nearer to the step than to the state. Its
  /// scan is not used then, though the growing sigma of the state would let it pass: a step from 5
  /// m/s to 0 was followed half a second later.
  [[nodiscard]] bool is_after_step(std::size_t radar, const Eigen::Vector2d& velocity_mps) const;

 private:
  /// See note_step().
  struct Step {
    std::int64_t used_us = 0;  // Of the last scan used before.
    double mps = 0.0;
  };

  OdometryState& state_;
  RadarConsensus& consensus_;
  FilterCondition& condition_;
  std::optional<Step> step_;
};

}  // namespace cremed
