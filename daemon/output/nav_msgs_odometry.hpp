// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <nav_msgs/Odometry.hpp>

#include "cremed/estimator/fusion/state/odometry.hpp"

namespace cremed {

/// The odometry as robot stacks of ROS's kind read it: pose in "odom", twist in "base_link", which
/// is the vehicle frame. The message has no status: what is not to be used is not published.
class NavMsgsOdometry {
 public:
  NavMsgsOdometry();

  /// Takes a new odometry over; false if there is none to publish. Allocates nothing.
  bool update(const Odometry& odometry);
  [[nodiscard]] const nav_msgs::Odometry& message() const { return message_; }

 private:
  nav_msgs::Odometry message_;
  std::int32_t next_seq_ = 0;
};

}  // namespace cremed
