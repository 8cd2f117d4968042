// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/output/nav_msgs_odometry.hpp"

#include <array>
#include <cmath>

namespace cremed {
namespace {

// Covariances of the message are ordered x, y, z, roll, pitch, yaw.
constexpr Eigen::Index kStates = 6;
using Covariance = Eigen::Matrix<double, kStates, kStates, Eigen::RowMajor>;
constexpr std::array<Eigen::Index, 3> kXYYaw = {0, 1, 5};
/// Variance of z, roll and pitch, which are not estimated. Zero would mean exactly known.
constexpr double kUnknownVariance = 1e6;
constexpr std::int64_t kUsPerSecond = 1'000'000;

void clear(double (&row_major)[36]) {
  Eigen::Map<Covariance> covariance(&row_major[0]);
  covariance.setZero();
  covariance.diagonal().setConstant(kUnknownVariance);
}

void fill(const Eigen::Matrix3d& x_y_yaw, double (&row_major)[36]) {
  Eigen::Map<Covariance> covariance(&row_major[0]);
  covariance(kXYYaw, kXYYaw) = x_y_yaw;
}

}  // namespace

NavMsgsOdometry::NavMsgsOdometry() : message_{} {
  message_.header.frame_id = "odom";
  message_.child_frame_id = "base_link";
  clear(message_.pose.covariance);
  clear(message_.twist.covariance);
}

bool NavMsgsOdometry::update(const Odometry& odometry) {
  if (!odometry.is_usable() && odometry.status != OdometryStatus::predicted) {
    return false;
  }
  message_.header.seq = next_seq_++;
  message_.header.stamp.sec = static_cast<std::int32_t>(odometry.utime_us / kUsPerSecond);
  message_.header.stamp.nsec = static_cast<std::int32_t>(odometry.utime_us % kUsPerSecond * 1000);
  geometry_msgs::Pose& pose = message_.pose.pose;
  pose.position.x = odometry.odom_pose.x();
  pose.position.y = odometry.odom_pose.y();
  pose.orientation.z = std::sin(odometry.odom_pose.z() / 2.0);
  pose.orientation.w = std::cos(odometry.odom_pose.z() / 2.0);
  fill(odometry.odom_covariance, message_.pose.covariance);
  geometry_msgs::Twist& twist = message_.twist.twist;
  twist.linear.x = odometry.twist.x();
  twist.linear.y = odometry.twist.y();
  twist.angular.z = odometry.twist.z();
  fill(odometry.twist_covariance, message_.twist.covariance);
  return true;
}

}  // namespace cremed
