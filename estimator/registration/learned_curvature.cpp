// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/registration/learned_curvature.hpp"

#include <Eigen/Cholesky>

namespace cremed {
namespace {

/// Least share of the complete information, in every direction, that is left after the missing
/// information. Steps are at most five times as long as those of EM.
constexpr double kMinCurvatureShare = 0.2;
/// A change of the gradient that differs less than this from the expected one, relative to the
/// step's information, is rounding and the rest of unfinished inner iterations.
constexpr double kMinShare = 1e-3;

}  // namespace

void LearnedCurvature::add(const Eigen::Vector3d& step, const Eigen::Vector3d& gradient_change,
                           const Eigen::Matrix3d& complete) {
  Eigen::Vector3d rest = (complete - missing_) * step - gradient_change;
  if (degrees_of_freedom_ == 2) {
    rest.y() = 0.0;
  }
  const double along = rest.dot(step);
  if (is_learning_ && along > kMinShare * step.dot(complete * step)) {
    missing_.noalias() += rest * rest.transpose() / along;
  }
}

void LearnedCurvature::stop() {
  is_learning_ = false;
  missing_.setZero();
}

Eigen::Matrix3d LearnedCurvature::of(const Eigen::Matrix3d& complete) const {
  Eigen::Matrix3d bounded = (1.0 - kMinCurvatureShare) * complete - missing_;
  if (degrees_of_freedom_ == 2) {
    bounded.row(1).setZero();
    bounded.col(1).setZero();
    bounded(1, 1) = 1.0;
  }
  const bool is_bounded = Eigen::LLT<Eigen::Matrix3d>(bounded).info() == Eigen::Success;
  return is_bounded ? Eigen::Matrix3d(complete - missing_) : complete;
}

}  // namespace cremed
