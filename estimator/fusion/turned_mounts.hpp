// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "cremed/estimator/fusion/position_fusion.hpp"
#include "cremed/estimator/fusion/state/linear_measurement.hpp"
#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"

namespace cremed {

/// The mount yaw of a radar while no other that looks ahead or back is heard, and a turn that the
/// mounts of all share; if others contradict a radar, FaultHypotheses finds which is wrong. With a
/// wrong yaw Doppler shows a lateral velocity that no vehicle has: as a slip, or, by one radar, as
/// a turn that the positions of the targets contradict. The odometry then learns the yaw anew.
class TurnedMounts {
 public:
  /// A mount turned by `yaw_rad`.
  struct Turn {
    double yaw_rad = 0.0;
    double yaw_rate_radps = 0.0;  ///< Of the vehicle.
    double yaw_rate_std_radps = 0.0;
    bool is_sudden = false;  ///< What was measured before it is of another mount.
  };

  /// `state` must outlive this object.
  explicit TurnedMounts(OdometryState& state)
      : state_(state),
        way_(state.radars(), Eigen::Vector2d::Zero()),
        before_restart_rad_(state.radars()) {}

  /// Whether it judges this radar: not one near the axle.
  [[nodiscard]] bool judges(std::size_t radar) const;

  /// To be called at a restart. A mount that is too far off may have turned back.
  void restart();
  /// To be called when the odometry has started: the mounts are as they were learned.
  void settle();
  /// To be called with scans of a radar that is not alone: what one showed alone counts no more,
  /// and all of them judge a mount that is too far off.
  void join();

  /// To be called when the lone radar's Doppler contradicts the state.
  void note_contradiction(std::size_t radar, std::int64_t stamp_us,
                          const LinearMeasurement& doppler, const Innovation& innovation);
  /// To be called when it does not. `by_positions`: of the same scan.
  void note_agreement(std::size_t radar, std::int64_t stamp_us,
                      const std::optional<PositionFusion::YawRate>& by_positions);

  /// To be called with a motion (v, w, slip) that no vehicle makes, by the lone radar alone. Counts
  /// before the first start only: later it may as well skid.
  void note_impossible_slip(const Eigen::Vector3d& motion);

  /// Returns, once, the turn of the mount that was detected; or the one without which the vehicle
  /// would turn or slip as none can.
  std::optional<Turn> take_turn(std::size_t radar);

  /// The turn that the mounts of these radars share: that of `motion`, (v, w, slip) of these radars
  /// with a slip that no vehicle has, or without it, if the slip of the state is such a one. The
  /// motion is corrected for mounts that turned only: what is learned of others, on average, is
  /// subtracted.
  [[nodiscard]] std::optional<Turn> common_turn(RadarSet radars,
                                                const std::optional<Eigen::Vector3d>& motion) const;

  /// Learns the radar's yaw anew, and takes the slip as unknown.
  void learn(std::size_t radar, const Turn& turn);
  /// The same of a turn that the mounts of these radars share; false if it is too large for that.
  bool learn_common(RadarSet radars, const Turn& turn);

  /// Turned so far that the linear model of the error does not hold, or upside down: the velocity
  /// is not known.
  [[nodiscard]] bool is_too_far(std::size_t radar) const;
  /// The radar moves sideways as only a vehicle does that turns about itself: its mount is turned
  /// by more than is learned.
  [[nodiscard]] bool moves_sideways(std::size_t radar) const;
  /// To be called with the velocity of a scan by Doppler, in the axes of the vehicle.
  void note_velocity(std::size_t radar, const Eigen::Vector2d& velocity_mps) {
    way_[radar] = kFadeOfWay * way_[radar] + velocity_mps;
  }
  /// With the yaw that would make it move straight ahead, as most of a drive does, averaged over
  /// its way. The state is not used: it takes the wrong yaw for a turn.
  [[nodiscard]] FaultCause cause_of_sideways(std::size_t radar) const;
  /// Whether it is, or was when the odometry last started, too far off.
  [[nodiscard]] bool is_left_out(std::size_t radar) const {
    return is_too_far(radar) || before_restart_rad_[radar] != 0.0;
  }
  /// The error of a mount that turned; unknown if it may as well be upside down.
  [[nodiscard]] FaultCause cause(std::size_t radar) const;

 private:
  static constexpr double kFadeOfWay = 0.999;  // A scan: a minute.

  /// Scans of one radar in succession that show a turn.
  struct Signs {
    std::size_t radar = 0;
    std::int64_t last_us = 0;
    int count = 0;

    /// True if they suffice: they then begin anew.
    bool add(std::size_t of_radar, std::int64_t stamp_us);
  };

  [[nodiscard]] double error_rad(std::size_t radar) const {
    return state_.gaussian.mean(state_.error(radar, state_layout::kMountYaw));
  }
  [[nodiscard]] std::optional<Turn> impossible_motion(std::size_t radar) const;
  [[nodiscard]] bool slips_by(double sigmas) const;
  [[nodiscard]] Turn by_slip() const;
  void start_motion_if_sudden(const Turn& turn);
  [[nodiscard]] Turn by_yaw_rate(std::size_t radar, double radps, double std_radps) const;
  [[nodiscard]] bool may_be_upside_down(std::size_t radar, double error_rad) const;
  void forget_signs();

  OdometryState& state_;
  bool has_settled_ = false;
  Signs by_doppler_;
  Signs by_positions_;
  std::optional<Turn> turn_;
  std::vector<Eigen::Vector2d> way_;        // By radar: sum of its velocities, faded.
  std::vector<double> before_restart_rad_;  // By radar: the error if it was too large, or 0.
};

}  // namespace cremed
