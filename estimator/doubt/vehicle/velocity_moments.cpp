// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/velocity_moments.hpp"

#include <algorithm>

#include <Eigen/LU>

#include "cremed/estimator/scan/squared.hpp"

namespace cremed {

void VelocityMoments::add(const Eigen::Vector2d& expected, const Eigen::Vector2d& measured,
                          double yaw_rate_radps, const Eigen::Vector2d& weight) {
  const Eigen::Vector4d along(expected.x(), measured.x(), measured.y(), 0.0);
  const Eigen::Vector4d across(expected.y(), measured.x(), measured.y(), yaw_rate_radps);
  along_ += weight.x() * along * along.transpose();
  across_ += weight.y() * across * across.transpose();
  count_ += 1.0;
}

void VelocityMoments::fade(double factor) {
  along_ *= factor;
  across_ *= factor;
  count_ *= factor;
}

/// Residuals: e_x - (1 + scale) M_x, and e_y - M_y - yaw M_x + x w, with M = of_measured m.
VelocityMoments::Fit VelocityMoments::fit(const Eigen::Matrix2d& of_measured,
                                          const Errors& errors) const {
  const Eigen::Vector4d forward(0.0, of_measured(0, 0), of_measured(0, 1), 0.0);
  const Eigen::Vector4d left(0.0, of_measured(1, 0), of_measured(1, 1), 0.0);
  const Eigen::Vector4d along = Eigen::Vector4d::UnitX() - forward;
  const Eigen::Vector4d across = Eigen::Vector4d::UnitX() - left;
  Fit fit;
  const double scaled = along.dot(along_ * forward);
  fit.scale = scaled / (forward.dot(along_ * forward) + 1.0 / squared(errors.scale));
  Eigen::Matrix<double, 4, 2> by;
  by << forward, -Eigen::Vector4d::UnitW();
  const Eigen::Vector2d turned = by.transpose() * across_ * across;
  Eigen::Matrix2d information = by.transpose() * across_ * by;
  information(0, 0) += 1.0 / squared(errors.yaw_rad);
  information(1, 1) += 1.0 / squared(errors.x_m);
  const Eigen::Vector2d solution = information.inverse() * turned;
  fit.yaw_rad = solution.x();
  fit.x_m = solution.y();
  fit.chi_square = std::max(0.0, along.dot(along_ * along) - scaled * fit.scale +
                                     across.dot(across_ * across) - turned.dot(solution));
  return fit;
}

}  // namespace cremed
