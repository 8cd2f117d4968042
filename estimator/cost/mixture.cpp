// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/cost/mixture.hpp"

#include <algorithm>
#include <cmath>

#include "cremed/estimator/cost/exponentiate.hpp"

namespace cremed {
namespace {

/// Keeps the radicand of the second residual positive (RA-L 2021; value of the reference).
constexpr double kDamping = 10.0;

/// A component whose squared distance exceeds the least by this is left out: its exponential is
/// 4e-44 of the nearest one's, and 1 / sqrt(det C) makes up for 1e12 of it with targets of 1e-6 m
/// beside a ray of metres.
constexpr double kNegligible = 200.0;

/// L with L'L = C^-1, upper triangular.
Eigen::Matrix2d whitening_of(const Symmetric2& c) {
  const double root_det = std::sqrt(c.determinant());
  const double root_yy = std::sqrt(c.yy);
  Eigen::Matrix2d result;
  result << root_yy / root_det, -c.xy / (root_yy * root_det), 0.0, 1.0 / root_yy;
  return result;
}

}  // namespace

void Mixture::push(double x_m, double y_m, const Symmetric2& covariance_m2, double weight) {
  const std::size_t j = size_++;
  x_m_[j] = x_m;
  y_m_[j] = y_m;
  xx_[j] = covariance_m2.xx;
  xy_[j] = covariance_m2.xy;
  yy_[j] = covariance_m2.yy;
  weight_[j] = weight;
}

void Mixture::assign(const TargetSet& targets, const OutlierRay& ray) {
  size_ = 0;
  const double target_weight = (1.0 - ray.weight()) / static_cast<double>(targets.size());
  for (const Target& target : targets) {
    push(target.x_m, target.y_m, target.covariance_m2, target_weight);
  }
  for (const RayComponent& component : ray) {
    push(component.x_m, component.y_m, component.covariance_m2, component.weight);
  }
  log_damped_size_ = std::log(static_cast<double>(size_) + kDamping);
}

/// Without branches and by columns, so that a release build vectorises it.
void Mixture::find_distances(const Eigen::Vector2d& point_m, const Symmetric2& covariance_m2) {
  const double x_m = point_m.x();
  const double y_m = point_m.y();
  const Symmetric2 own = covariance_m2;
  for (std::size_t j = 0; j < size_; ++j) {
    const double ex = x_m - x_m_[j];
    const double ey = y_m - y_m_[j];
    const double cxx = own.xx + xx_[j];
    const double cxy = own.xy + xy_[j];
    const double cyy = own.yy + yy_[j];
    const double inverse_det = 1.0 / (cxx * cyy - cxy * cxy);
    const double gx = (cyy * ex - cxy * ey) * inverse_det;
    const double gy = (cxx * ey - cxy * ex) * inverse_det;
    gx_[j] = gx;
    gy_[j] = gy;
    squared_distance_[j] = ex * gx + ey * gy;
    inverse_det_[j] = inverse_det;
  }
}

/// Lists the components that are not negligible, with their exponentials.
void Mixture::list_near(double least_squared_distance) {
  near_count_ = 0;
  // Without branches, because they would be unpredictable.
  for (std::size_t j = 0; j < size_; ++j) {
    const double excess = squared_distance_[j] - least_squared_distance;
    near_[near_count_] = j;
    exponential_[near_count_] = -0.5 * excess;
    near_count_ += excess > kNegligible ? 0U : 1U;
  }
  exponentiate({exponential_.data(), near_count_});
}

MixtureResidual Mixture::evaluate(const Eigen::Vector2d& point_m, const Symmetric2& covariance_m2) {
  find_distances(point_m, covariance_m2);
  // Exponents are relative to the nearest component, which avoids underflow and overflow.
  const double* const first = squared_distance_.data();
  const double least = *std::min_element(first, first + size_);
  list_near(least);
  double sum_q = 0.0;
  Eigen::Vector2d sum_qg = Eigen::Vector2d::Zero();
  double best_q = -1.0;
  std::size_t best = 0;
  for (std::size_t n = 0; n < near_count_; ++n) {
    const std::size_t j = near_[n];
    const double q = weight_[j] * std::sqrt(inverse_det_[j]) * exponential_[n];
    sum_q += q;
    sum_qg += q * Eigen::Vector2d(gx_[j], gy_[j]);
    best = q > best_q ? j : best;
    best_q = std::max(best_q, q);
  }
  const Eigen::Vector2d error_m = point_m - Eigen::Vector2d(x_m_[best], y_m_[best]);
  const Eigen::Matrix2d whitening =
      whitening_of(covariance_m2 + Symmetric2{xx_[best], xy_[best], yy_[best]});
  const double rest = std::sqrt(2.0 * (log_damped_size_ - std::log(sum_q / best_q)));
  MixtureResidual result;
  result.residual << whitening * error_m, rest;
  result.jacobian << whitening,
      (sum_qg / sum_q - Eigen::Vector2d(gx_[best], gy_[best])).transpose() / rest;
  result.cost = 0.5 * least - std::log(sum_q);
  return result;
}

}  // namespace cremed
