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

/// Composition of `start` and `motion` with independent errors: covariance F P F' + G C G' with the
/// derivatives F, G of the pose by start and by motion.
UncertainPose chained(const UncertainPose& start, const UncertainPose& motion);

/// Whether one motion may begin where the other ends.
bool is_same_stamp(std::int64_t a_us, std::int64_t b_us);

/// Chained motions. Motions with one begin (rows with the same anchor) give poses along the path; a
/// motion that begins at the end of the last one is chained there.
class MotionChain {
 public:
  explicit MotionChain(std::int64_t begin_us) : joint_us_(begin_us), end_us_(begin_us) {}

  /// False, and nothing is added, if the motion begins neither where the last ones began nor where
  /// they ended: a gap.
  bool add(const RecordedEstimate& motion);

  /// End of the last motion, in the frame of the chain's begin.
  [[nodiscard]] const UncertainPose& end() const { return end_; }
  [[nodiscard]] std::int64_t end_us() const { return end_us_; }
  /// Sum of the straight distances between the ends of the motions, as estimated.
  [[nodiscard]] double driven_m() const { return driven_m_; }

 private:
  bool moves_to_joint(std::int64_t start_us);

  UncertainPose joint_;  ///< Begin of the last motion.
  UncertainPose end_;
  std::int64_t joint_us_;
  std::int64_t end_us_;
  double driven_m_ = 0.0;
};

}  // namespace cremed
