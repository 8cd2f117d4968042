// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "tools/eval/drive/recorded_odometry.hpp"

namespace cremed {

/// A pose (x_m, y_m, yaw_rad) with its covariance in the same order.
struct UncertainPose {
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// `motion`, seen in the frame of `start`, put behind it; their errors are taken as independent:
/// covariance F P F' + G C G' with the derivatives F, G of the pose by start and by motion.
UncertainPose chained(const UncertainPose& start, const UncertainPose& motion);

/// Motions one behind the other. Those of one begin (rows that refer to the same anchor) tell poses
/// along the way; where a motion begins at the end of the one before, that end is chained.
class MotionChain {
 public:
  explicit MotionChain(std::int64_t begin_us) : joint_us_(begin_us), end_us_(begin_us) {}

  /// False, and nothing is added, where the motion begins neither where those before it began nor
  /// where they end: a gap.
  bool add(const RecordedEstimate& motion);

  /// Where the last motion ended, in the frame of the chain's begin.
  [[nodiscard]] const UncertainPose& end() const { return end_; }
  [[nodiscard]] std::int64_t end_us() const { return end_us_; }
  /// Straight from end to end of the motions, as estimated.
  [[nodiscard]] double driven_m() const { return driven_m_; }

 private:
  bool moves_to_joint(std::int64_t start_us);

  UncertainPose joint_;  ///< Where the last motion began.
  UncertainPose end_;
  std::int64_t joint_us_;
  std::int64_t end_us_;
  double driven_m_ = 0.0;
};

/// Each motion from where the one before it ended, if both have one begin; else as it is. What
/// refers to anchors becomes what joins; covariances are left as they are.
std::vector<RecordedEstimate> from_end_to_end(const std::vector<RecordedEstimate>& estimates);

}  // namespace cremed
