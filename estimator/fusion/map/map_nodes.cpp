// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/map/map_nodes.hpp"

#include <cmath>
#include <utility>

#include "cremed/estimator/fusion/state/pose_chain.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {

void MapNodes::advance() {
  const double speed_mps = state_.gaussian.mean(state_layout::kSpeed);
  const bool was_moving =
      std::exchange(is_moving_, std::abs(speed_mps) > state_.options().standstill_mps);
  if (is_moving_ && !was_moving) {
    moving_since_us_ = state_.time_us();
  }
}

bool MapNodes::add_if_due(std::int64_t stamp_us, double age_s) {
  if (!is_due(stamp_us, age_s)) {
    return false;
  }
  newest_ = (newest_ + 1) % state_layout::kNodes;
  stamp_us_[newest_] = stamp_us;
  is_empty_ = false;
  state_.clone_node(newest_, age_s);
  return true;
}

bool MapNodes::is_due(std::int64_t stamp_us, double age_s) const {
  const OdometryOptions& options = state_.options();
  if (is_empty_) {
    return true;
  }
  const Eigen::Vector3d moved =
      relative_pose(state_.node_pose(newest_), state_.pose_before(age_s).pose);
  return seconds_between(stamp_us_[newest_], stamp_us) >= options.node_period_s &&
         (moved.head<2>().norm() > options.node_way_m ||
          std::abs(moved.z()) > options.node_turn_rad);
}

}  // namespace cremed
