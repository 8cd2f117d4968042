// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "cremed/estimator/fusion/state/odometry_state.hpp"

namespace cremed {

/// The nodes of the maps: a ring of clones of the vehicle's pose, shared by all radars. A new node
/// replaces the oldest.
class MapNodes {
 public:
  /// `state` must outlive this object.
  explicit MapNodes(OdometryState& state) : state_(state) {}

  void clear() { is_empty_ = true; }
  /// Adds the pose at a scan that is `age_s` older than the state, if a node is due: node_period_s
  /// after the last and after a motion, so that the maps of a standing vehicle stay.
  bool add_if_due(std::int64_t stamp_us, double age_s);
  [[nodiscard]] std::size_t newest() const { return newest_; }
  [[nodiscard]] std::int64_t stamp_us(std::size_t node) const { return stamp_us_[node]; }

 private:
  [[nodiscard]] bool is_due(std::int64_t stamp_us, double age_s) const;

  OdometryState& state_;
  std::size_t newest_ = 0;
  bool is_empty_ = true;
  std::array<std::int64_t, state_layout::kNodes> stamp_us_{};
};

}  // namespace cremed
