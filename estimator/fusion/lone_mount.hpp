// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "cremed/estimator/fusion/position_fusion.hpp"
#include "cremed/estimator/fusion/state/linear_measurement.hpp"
#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"

namespace cremed {

/// The mount yaw of the only radar that is heard (with others FaultHypotheses finds a wrong one).
/// If it is wrong, Doppler shows a lateral velocity that no vehicle has: as a slip, or as a turn
/// that the positions of the targets contradict. The odometry then learns the yaw anew.
class LoneMount {
 public:
  /// A mount turned by `yaw_rad`.
  struct Turn {
    double yaw_rad = 0.0;
    double yaw_rate_radps = 0.0;  ///< Of the vehicle.
    bool is_sudden = false;       ///< What was measured before it is of another mount.
  };

  /// `state` must outlive this object.
  explicit LoneMount(OdometryState& state) : state_(state), before_restart_rad_(state.radars()) {}

  /// To be called at a restart. A mount that is too far off may have turned back.
  void restart();
  /// To be called with a radar that is not the only one, instead of the functions below: what the
  /// single radar showed counts no more, and the others judge a mount that is too far off.
  void join(std::size_t radar);
  /// To be called when the odometry has started: the mounts are as they were learned.
  void settle() { std::fill(before_restart_rad_.begin(), before_restart_rad_.end(), 0.0); }

  /// To be called when the only radar's Doppler contradicts the state.
  void note_contradiction(std::size_t radar, const LinearMeasurement& doppler,
                          const Innovation& innovation);
  /// To be called when it does not. `by_positions`: of the same scan.
  void note_agreement(std::size_t radar,
                      const std::optional<PositionFusion::YawRate>& by_positions);

  /// The turn that was noted, once; or one without which the vehicle turns or slips as none can.
  std::optional<Turn> take_turn(std::size_t radar);

  /// Learns the radar's yaw anew, and takes the slip as unknown.
  void learn(std::size_t radar, const Turn& turn);

  /// Turned so far that the linear model of the error does not hold, or upside down: the velocity
  /// is not known.
  [[nodiscard]] bool is_too_far(std::size_t radar) const;
  /// Whether it is or was so when the odometry last started.
  [[nodiscard]] bool is_left_out(std::size_t radar) const {
    return is_too_far(radar) || before_restart_rad_[radar] != 0.0;
  }
  /// The error of a mount that turned; unknown if it may as well be upside down.
  [[nodiscard]] FaultCause cause(std::size_t radar) const;

 private:
  [[nodiscard]] double error_rad(std::size_t radar) const {
    return state_.gaussian.mean(state_.error(radar, state_layout::kMountYaw));
  }
  [[nodiscard]] bool may_be_upside_down(std::size_t radar, double error_rad) const;
  [[nodiscard]] Turn by_yaw_rate(std::size_t radar, double radps) const;

  void forget_signs();

  OdometryState& state_;
  int contradictions_ = 0;               // Of Doppler, in succession.
  int contradictions_by_positions_ = 0;  // Likewise.
  std::optional<Turn> turn_;
  std::vector<double> before_restart_rad_;  // By radar: the error if it was too large, or 0.
};

}  // namespace cremed
