// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "cremed/estimator/fusion/state/odometry_state.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {

/// The nodes of the maps: a ring of clones of the vehicle's pose, shared by all radars. A new node
/// replaces the oldest.
class MapNodes {
 public:
  /// `state` must outlive this object.
  explicit MapNodes(OdometryState& state) : state_(state) {}

  void clear() {
    is_empty_ = true;
    is_moving_ = false;  // moving_since_us_ may be a time of a clock that was set since.
  }
  /// Notes whether the vehicle moves, to be called at each scan.
  void advance();
  /// Adds the pose at a scan that is `age_s` older than the state, if a node is due: node_period_s
  /// after the last and after a motion, so that the maps of a standing vehicle stay.
  bool add_if_due(std::int64_t stamp_us, double age_s);
  [[nodiscard]] std::size_t newest() const { return newest_; }
  /// The time since a node in which an error of the present speed added up: without a rest before.
  [[nodiscard]] double since_s(std::size_t node) const {
    return seconds_between(std::max(stamp_us_[node], moving_since_us_), state_.time_us());
  }

 private:
  [[nodiscard]] bool is_due(std::int64_t stamp_us, double age_s) const;

  OdometryState& state_;
  std::size_t newest_ = 0;
  bool is_empty_ = true;
  bool is_moving_ = false;
  std::int64_t moving_since_us_ = 0;  // The last start from rest.
  std::array<std::int64_t, state_layout::kNodes> stamp_us_{};
};

}  // namespace cremed
