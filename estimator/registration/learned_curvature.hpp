// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace cremed {

/// Curvature of a cost along an EM search. Steps by the complete information converge slowly if
/// much information is missing: each leaves the missing share of the way. How much is missing shows
/// in the change of the gradient from step to step (symmetric rank-one update, Nocedal and Wright,
/// "Numerical Optimization", 6.2), which costs no evaluation.
class LearnedCurvature {
 public:
  explicit LearnedCurvature(int degrees_of_freedom) : degrees_of_freedom_(degrees_of_freedom) {}

  /// Learns from a step and the change of the gradient along it.
  void add(const Eigen::Vector3d& step, const Eigen::Vector3d& gradient_change,
           const Eigen::Matrix3d& complete);

  /// Forgets and learns no more: to be called if steps do not shrink.
  void stop();

  /// Complete minus missing information; complete if too much would be missing.
  [[nodiscard]] Eigen::Matrix3d of(const Eigen::Matrix3d& complete) const;

 private:
  int degrees_of_freedom_;
  bool is_learning_ = true;
  Eigen::Matrix3d missing_ = Eigen::Matrix3d::Zero();
};

}  // namespace cremed
