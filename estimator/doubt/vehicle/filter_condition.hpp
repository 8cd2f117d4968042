// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>

#include "cremed/estimator/doubt/vehicle/fault_hypotheses.hpp"
#include "cremed/estimator/doubt/vehicle/radar_consensus.hpp"
#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"

namespace cremed {

/// Validity of the filter's output: how well the state is observed, and how recent its measurements
/// are.
class FilterCondition {
 public:
  /// The arguments must outlive this object.
  FilterCondition(const OdometryState& state, const RadarConsensus& consensus,
                  const FaultHypotheses& faults)
      : state_(state), consensus_(consensus), faults_(faults) {}

  void start();
  /// Records that a scan's Doppler was used. `is_clear`: most of its targets are static.
  void use_scan(bool is_clear);
  /// Records a scan that is not used because it is unknown which of its targets, or which radars,
  /// show the vehicle's motion: it shows two worlds (TwoWorlds), or radars contradict each other.
  void doubt();
  /// The mount of the lone radar, or all mounts, are too far off: the velocity is not known.
  void unsettle();

  /// Ends the start if the state is known; true if it ends now.
  bool settle();

  [[nodiscard]] int used_scans() const { return used_scans_; }
  [[nodiscard]] std::int64_t used_us() const { return used_us_; }
  /// Since the last scan that was used.
  [[nodiscard]] double unused_s(std::int64_t at_us) const;
  /// A scan shortly before was not used because of a doubt.
  [[nodiscard]] bool is_doubtful(std::int64_t at_us) const;
  /// The start is over: the state no longer depends on the prior.
  [[nodiscard]] bool is_settled() const { return is_settled_; }
  /// The speed is so uncertain that the gate on Doppler would accept wrong speeds.
  [[nodiscard]] bool is_speed_unknown() const;
  [[nodiscard]] bool is_lost() const;
  /// As defined by OdometryStatus.
  [[nodiscard]] OdometryStatus status(const Odometry& odometry) const;

 private:
  [[nodiscard]] bool is_known() const;
  /// The state is at rest, but so may be traffic relative to the vehicle.
  [[nodiscard]] bool may_drive_in_traffic() const;

  const OdometryState& state_;
  const RadarConsensus& consensus_;
  const FaultHypotheses& faults_;
  bool is_settled_ = false;
  int used_scans_ = 0;
  std::int64_t used_us_ = 0;   // Last scan used.
  std::int64_t clear_us_ = 0;  // Last clear scan used.
  // Last scan in doubt.
  std::int64_t doubt_us_ = std::numeric_limits<std::int64_t>::min() / 2;
  int doubts_ = 0;  // Scans in doubt less scans used, 0 to kMaxDoubts.
};

}  // namespace cremed
