// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/mixture.hpp"

#include <cmath>

namespace cremed {
namespace {

/// Keeps the argument of the second residual's root positive (RA-L 2021; value of the reference).
constexpr double kDamping = 10.0;

/// Components whose squared distance exceeds the nearest one's by more than this add less than
/// 1e-11 of it and are left out.
constexpr double kNegligible = 50.0;

using ConstRow = Eigen::Map<const Eigen::ArrayXd>;

/// L with L'L = C^-1, upper triangular.
Eigen::Matrix2d square_root_information(const Symmetric2& c, double inverse_determinant) {
  const double a = std::sqrt(c.yy * inverse_determinant);
  Eigen::Matrix2d root;
  root << a, -c.xy * inverse_determinant / a, 0.0, 1.0 / std::sqrt(c.yy);
  return root;
}

}  // namespace

void Mixture::push(double x_m, double y_m, const Symmetric2& covariance_m2, double weight) {
  x_m_[size_] = x_m;
  y_m_[size_] = y_m;
  xx_[size_] = covariance_m2.xx;
  xy_[size_] = covariance_m2.xy;
  yy_[size_] = covariance_m2.yy;
  weight_[size_] = weight;
  ++size_;
}

void Mixture::assign(const TargetSet& targets, const OutlierRay& ray) {
  size_ = 0;
  double ray_weight = 0.0;
  for (const RayComponent& component : ray) {
    ray_weight += component.weight;
  }
  const double target_weight = (1.0 - ray_weight) / static_cast<double>(targets.size());
  for (const Target& target : targets) {
    push(target.x_m, target.y_m, target.covariance_m2, target_weight);
  }
  for (const RayComponent& component : ray) {
    push(component.x_m, component.y_m, component.covariance_m2, component.weight);
  }
}

/// This loop is the hot spot of the daemon; it is kept free of branches and calls so that the
/// compiler vectorises it.
void Mixture::compute_distances(const Eigen::Vector2d& point_m, const Symmetric2& covariance_m2) {
  const double px = point_m.x();
  const double py = point_m.y();
  const Symmetric2 own = covariance_m2;
  const std::size_t size = size_;
  for (std::size_t j = 0; j < size; ++j) {
    const double ex = px - x_m_[j];
    const double ey = py - y_m_[j];
    const double cxx = xx_[j] + own.xx;
    const double cxy = xy_[j] + own.xy;
    const double cyy = yy_[j] + own.yy;
    const double inverse = 1.0 / (cxx * cyy - cxy * cxy);
    inverse_determinant_[j] = inverse;
    squared_distance_[j] = (cyy * ex * ex - 2.0 * cxy * ex * ey + cxx * ey * ey) * inverse;
  }
}

/// Lists the components that matter at the point; returns how many. Without a branch: which
/// components matter is as good as random.
std::size_t Mixture::collect_active(double nearest) {
  std::size_t count = 0;
  for (std::size_t j = 0; j < size_; ++j) {
    active_[count] = j;
    exponent_[count] = -0.5 * (squared_distance_[j] - nearest);
    count += squared_distance_[j] - nearest < kNegligible ? 1U : 0U;
  }
  return count;
}

void Mixture::compute_likelihoods(std::size_t active_count) {
  for (std::size_t k = 0; k < active_count; ++k) {
    const std::size_t j = active_[k];
    likelihood_[k] = weight_[j] * std::sqrt(inverse_determinant_[j]);
  }
  const auto count = static_cast<Eigen::Index>(active_count);
  Eigen::Map<Eigen::ArrayXd>(likelihood_.data(), count) *= ConstRow(exponent_.data(), count).exp();
}

MixtureResidual Mixture::evaluate(const Eigen::Vector2d& point_m, const Symmetric2& covariance_m2) {
  compute_distances(point_m, covariance_m2);
  // Exponents are taken relative to the nearest component: nothing under- or overflows.
  const double nearest =
      ConstRow(squared_distance_.data(), static_cast<Eigen::Index>(size_)).minCoeff();
  const std::size_t active_count = collect_active(nearest);
  compute_likelihoods(active_count);

  // g_ij = C_ij^-1 e, the gradient of half the squared distance to component j.
  double sum = 0.0;
  double sum_gx = 0.0;
  double sum_gy = 0.0;
  double best_gx = 0.0;
  double best_gy = 0.0;
  std::size_t best = 0;
  for (std::size_t k = 0; k < active_count; ++k) {
    const std::size_t j = active_[k];
    const double q = likelihood_[k];
    const double ex = point_m.x() - x_m_[j];
    const double ey = point_m.y() - y_m_[j];
    const double cxy = xy_[j] + covariance_m2.xy;
    const double gx = ((yy_[j] + covariance_m2.yy) * ex - cxy * ey) * inverse_determinant_[j];
    const double gy = ((xx_[j] + covariance_m2.xx) * ey - cxy * ex) * inverse_determinant_[j];
    sum += q;
    sum_gx += q * gx;
    sum_gy += q * gy;
    if (k == 0 || q > likelihood_[best]) {
      best = k;
      best_gx = gx;
      best_gy = gy;
    }
  }

  MixtureResidual result;
  const std::size_t j = active_[best];
  result.component = j;
  result.cost = 0.5 * nearest - std::log(sum);
  const Symmetric2 covariance{xx_[j] + covariance_m2.xx, xy_[j] + covariance_m2.xy,
                              yy_[j] + covariance_m2.yy};
  const Eigen::Matrix2d root = square_root_information(covariance, inverse_determinant_[j]);
  const double rest = std::sqrt(
      2.0 * (std::log(static_cast<double>(size_) + kDamping) - std::log(sum / likelihood_[best])));
  result.residual << root * Eigen::Vector2d(point_m.x() - x_m_[j], point_m.y() - y_m_[j]), rest;
  result.jacobian.topRows<2>() = root;
  result.jacobian.row(2) << (sum_gx / sum - best_gx) / rest, (sum_gy / sum - best_gy) / rest;
  return result;
}

}  // namespace cremed
