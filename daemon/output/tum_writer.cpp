// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/output/tum_writer.hpp"

#include <cmath>

#include "cremed/estimator/fusion/state/pose_chain.hpp"

namespace cremed {

void TumWriter::on_motion(std::size_t radar, const EgoMotion& motion, std::int32_t /*solve_us*/) {
  if (radar != radar_ || !motion.has_estimate()) {
    return;
  }
  begin(motion.utime_start_us);
  pose_ = composed_pose(pose_, motion.motion);
  write_pose(motion.utime_us);
}

void TumWriter::on_odometry(const Odometry& odometry) {
  if (!radar_) {
    begin(odometry.utime_before_us);
    pose_ = odometry.odom_pose;
    write_pose(odometry.utime_us);
  }
}

/// Starts a motion there.
void TumWriter::begin(std::int64_t utime_us) {
  if (!has_begun_) {
    has_begun_ = true;
    write_pose(utime_us);
  } else if (utime_us != utime_us_) {
    ++gaps_;
  }
}

void TumWriter::write_pose(std::int64_t utime_us) {
  utime_us_ = utime_us;
  file_.write(tum_line(utime_us, {pose_.x(), pose_.y(), pose_.z()}).view());
}

TextLine tum_line(std::int64_t utime_us, const Pose2& pose) {
  TextLine line;
  line.fixed(static_cast<double>(utime_us) * 1e-6, 6);
  line.text(" ").fixed(pose.x_m, 6).text(" ").fixed(pose.y_m, 6).text(" 0 0 0 ");
  line.fixed(std::sin(pose.yaw_rad / 2.0), 9).text(" ").fixed(std::cos(pose.yaw_rad / 2.0), 9);
  line.text("\n");
  return line;
}

}  // namespace cremed
