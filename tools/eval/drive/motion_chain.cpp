// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/motion_chain.hpp"

#include <cmath>
#include <cstdlib>

namespace cremed {
namespace {

/// Stamps may differ by their rounding to microseconds.
constexpr std::int64_t kSameStampUs = 2;

}  // namespace

bool is_same_stamp(std::int64_t a_us, std::int64_t b_us) {
  return std::abs(a_us - b_us) <= kSameStampUs;
}

UncertainPose chained(const UncertainPose& start, const UncertainPose& motion) {
  const double c = std::cos(start.pose.z());
  const double s = std::sin(start.pose.z());
  Eigen::Matrix3d by_motion = Eigen::Matrix3d::Identity();
  by_motion.topLeftCorner<2, 2>() << c, -s, s, c;
  const Eigen::Vector3d turned = by_motion * motion.pose;
  Eigen::Matrix3d by_start = Eigen::Matrix3d::Identity();
  by_start(0, 2) = -turned.y();
  by_start(1, 2) = turned.x();
  return {start.pose + turned, by_start * start.covariance * by_start.transpose() +
                                   by_motion * motion.covariance * by_motion.transpose()};
}

bool MotionChain::moves_to_joint(std::int64_t start_us) {
  if (is_same_stamp(start_us, end_us_)) {
    joint_ = end_;
    joint_us_ = end_us_;
  }
  return is_same_stamp(start_us, joint_us_);
}

bool MotionChain::add(const RecordedEstimate& motion) {
  if (!moves_to_joint(motion.start_us)) {
    return false;
  }
  const Eigen::Vector3d before = end_.pose;
  end_ = chained(joint_, {motion.motion, motion.covariance});
  end_us_ = motion.end_us;
  driven_m_ += (end_.pose - before).head<2>().norm();
  return true;
}

}  // namespace cremed
