// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/velocity_moments.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace cremed {
namespace {

using Vector = Eigen::Matrix<double, 5, 1>;

}  // namespace

void VelocityMoments::add(const Eigen::Vector2d& expected, const Eigen::Vector2d& measured,
                          double yaw_rate_radps, const Eigen::Vector2d& weight) {
  const Vector along(expected.x(), measured.x(), measured.y(), 0.0, 1.0);
  const Vector across(expected.y(), measured.x(), measured.y(), yaw_rate_radps, 1.0);
  along_ += weight.x() * along * along.transpose();
  across_ += weight.y() * across * across.transpose();
  count_ += 1.0;
}

void VelocityMoments::fade(double factor) {
  along_ *= factor;
  across_ *= factor;
  count_ *= factor;
}

/// Residuals: e_x - (1 + scale) M_x - offset u_x, and e_y - M_y - yaw M_x + x w - offset u_y, with
/// M = of_measured m and the direction of view u.
VelocityMoments::Fit VelocityMoments::fit(const Eigen::Matrix2d& of_measured, double view_rad,
                                          const Errors& errors) const {
  const Vector forward(0.0, of_measured(0, 0), of_measured(0, 1), 0.0, 0.0);
  const Vector left(0.0, of_measured(1, 0), of_measured(1, 1), 0.0, 0.0);
  const Vector along = Vector::UnitX() - forward;
  const Vector across = Vector::UnitX() - left;
  Eigen::Matrix<double, 5, 4> by_along;
  Eigen::Matrix<double, 5, 4> by_across;
  const Vector none = Vector::Zero();
  by_along << forward, none, none, std::cos(view_rad) * Vector::Unit(4);
  by_across << none, forward, -Vector::Unit(3), std::sin(view_rad) * Vector::Unit(4);
  const Eigen::Vector4d prior(errors.scale, errors.yaw_rad, errors.x_m, errors.offset_mps);
  const Eigen::Vector4d sum =
      by_along.transpose() * along_ * along + by_across.transpose() * across_ * across;
  Eigen::Matrix4d information =
      by_along.transpose() * along_ * by_along + by_across.transpose() * across_ * by_across;
  information.diagonal() += prior.cwiseAbs2().cwiseInverse();
  const Eigen::Vector4d solution = information.llt().solve(sum);
  return {
      std::max(0.0, along.dot(along_ * along) + across.dot(across_ * across) - sum.dot(solution)),
      solution(0), solution(1), solution(2), solution(3)};
}

}  // namespace cremed
