// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/cost/mixture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cremed {
namespace {

/// Keeps the radicand of the second residual positive (RA-L 2021; value of the reference).
constexpr double kDamping = 10.0;

}  // namespace

void Mixture::push(double x_m, double y_m, const Symmetric2& covariance_m2, double weight) {
  MixtureComponents& c = components_;
  const std::size_t j = c.size++;
  c.exact.x_m[j] = x_m;
  c.exact.y_m[j] = y_m;
  c.exact.xx[j] = covariance_m2.xx;
  c.exact.xy[j] = covariance_m2.xy;
  c.exact.yy[j] = covariance_m2.yy;
  c.weight[j] = weight;
}

void Mixture::assign(const TargetSet& targets, const OutlierRay& ray) {
  components_.size = 0;
  const double target_weight = (1.0 - ray.weight()) / static_cast<double>(targets.size());
  for (const Target& target : targets) {
    push(target.x_m, target.y_m, target.covariance_m2, target_weight);
  }
  for (const RayComponent& component : ray) {
    push(component.x_m, component.y_m, component.covariance_m2, component.weight);
  }
  components_.log_damped_size = std::log(static_cast<double>(components_.size) + kDamping);
  pad();
  bound_rounding();
}

/// Pads with copies of the last component of weight 0, which are never the nearest or the best.
void Mixture::pad() {
  MixtureComponents& c = components_;
  const std::size_t size = c.size;
  const std::size_t last = size - 1;
  const std::size_t padded = (size + MixtureComponents::kPadding - 1) /
                             MixtureComponents::kPadding * MixtureComponents::kPadding;
  while (c.size < padded) {
    push(c.exact.x_m[last], c.exact.y_m[last],
         {c.exact.xx[last], c.exact.xy[last], c.exact.yy[last]}, 0.0);
  }
  for (std::size_t j = 0; j < padded; ++j) {
    copy_rough(j);
  }
  c.size = size;
}

void Mixture::copy_rough(std::size_t j) {
  MixtureComponents& c = components_;
  // Bias of the exponent, contained in the log det that find_keys() reads from the bits.
  constexpr double kBias = 127.0 * 0.6931471805599453;
  c.rough.x_m[j] = static_cast<float>(c.exact.x_m[j]);
  c.rough.y_m[j] = static_cast<float>(c.exact.y_m[j]);
  c.rough.xx[j] = static_cast<float>(c.exact.xx[j]);
  c.rough.xy[j] = static_cast<float>(c.exact.xy[j]);
  c.rough.yy[j] = static_cast<float>(c.exact.yy[j]);
  c.rough_offset[j] = static_cast<float>(-2.0 * std::log(c.weight[j]) - kBias);
}

void Mixture::bound_rounding() {
  MixtureComponents& c = components_;
  c.max_eccentricity = 0.0;
  c.max_coordinate_m = 0.0;
  double min_variance = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < c.size; ++j) {
    const double trace = c.exact.xx[j] + c.exact.yy[j];
    const double det = c.exact.xx[j] * c.exact.yy[j] - c.exact.xy[j] * c.exact.xy[j];
    c.max_eccentricity = std::max(c.max_eccentricity, trace * trace / det);
    min_variance = std::min(min_variance, det / trace);
    c.max_coordinate_m =
        std::max({c.max_coordinate_m, std::abs(c.exact.x_m[j]), std::abs(c.exact.y_m[j])});
  }
  c.min_std_m = std::sqrt(min_variance);
}

void Mixture::evaluate(std::span<const MixturePoint> points, std::span<MixtureResidual> residuals) {
  for (std::size_t i = 0; i < points.size(); i += MixtureScratch::kBatch) {
    const std::size_t count = std::min(MixtureScratch::kBatch, points.size() - i);
    kernel_(components_, points.subspan(i, count), scratch_, residuals.subspan(i, count));
  }
}

MixtureResidual Mixture::evaluate(const Eigen::Vector2d& point_m, const Symmetric2& covariance_m2) {
  const MixturePoint point{point_m.x(), point_m.y(), covariance_m2};
  MixtureResidual residual;
  kernel_(components_, {&point, 1}, scratch_, {&residual, 1});
  return residual;
}

}  // namespace cremed
