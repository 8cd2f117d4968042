// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "cremed/estimator/fusion/gate/radar_consensus.hpp"
#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"

namespace cremed {

/// What the filter's output is worth: how much of its state rests on measurements, and how recent
/// they are.
class FilterCondition {
 public:
  /// Both must outlive this.
  FilterCondition(const OdometryState& state, const RadarConsensus& consensus)
      : state_(state), consensus_(consensus) {}

  void start();
  /// A scan's Doppler was used; `is_clear`: most of its targets are at rest.
  void use_scan(bool is_clear);
  /// A scan showed two worlds (TwoWorlds).
  void doubt() { doubt_us_ = state_.time_us(); }

  [[nodiscard]] bool has_used_scans() const { return used_scans_ > 0; }
  [[nodiscard]] std::int64_t used_us() const { return used_us_; }
  /// The start is over: the prior no longer shows.
  [[nodiscard]] bool is_settled() const { return is_settled_; }
  /// The speed is so uncertain that a gate on Doppler would pass any.
  [[nodiscard]] bool is_speed_unknown() const;
  [[nodiscard]] bool is_lost() const;
  /// By the definitions of OdometryStatus.
  [[nodiscard]] OdometryStatus status(const Odometry& odometry) const;

 private:
  [[nodiscard]] bool is_known() const;

  const OdometryState& state_;
  const RadarConsensus& consensus_;
  bool is_settled_ = false;
  int used_scans_ = 0;
  std::int64_t used_us_ = 0;   // Last scan used.
  std::int64_t clear_us_ = 0;  // Last one that was clear.
  std::int64_t doubt_us_ = 0;  // Last scan that showed two worlds.
};

}  // namespace cremed
