// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <nav_msgs/Odometry.hpp>

#include "cremed/estimator/fusion/state/odometry.hpp"

namespace cremed {

/// The odometry in ROS conventions: pose in "odom", twist in "base_link", the vehicle frame. The
/// message has no status, so unusable odometry is not published.
class NavMsgsOdometry {
 public:
  NavMsgsOdometry();

  /// Converts a new odometry; false if it is not to be published. Allocates nothing.
  bool update(const Odometry& odometry);
  [[nodiscard]] const nav_msgs::Odometry& message() const { return message_; }

 private:
  nav_msgs::Odometry message_;
  std::int32_t next_seq_ = 0;
};

}  // namespace cremed
