// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>

#include "cremed/estimator/cost/mixture_kernel.hpp"
#include "cremed/estimator/cost/outlier_ray.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// The previous scan as a Gaussian mixture, (1) of the README: one component for each target, and
/// the outlier ray.
class Mixture {
 public:
  /// Uses the fastest kernel of this machine.
  Mixture() : Mixture(mixture_kernels().front().kernel) {}
  explicit Mixture(MixtureKernel kernel) : kernel_(kernel) {}

  /// Weight (1 - w_o) / F for each of the F targets, w_o in total for the ray.
  void assign(const TargetSet& targets, const OutlierRay& ray);

  /// One residual for each point, in the mixture's frame. Covariances are held fixed in the
  /// Jacobian. The mixture must not be empty. Uses scratch space of the object. A batch is much
  /// faster than single points, with the same result.
  void evaluate(std::span<const MixturePoint> points, std::span<MixtureResidual> residuals);

  /// The same for one point.
  MixtureResidual evaluate(const Eigen::Vector2d& point_m, const Symmetric2& covariance_m2);

  [[nodiscard]] std::size_t size() const { return components_.size; }

 private:
  void push(double x_m, double y_m, const Symmetric2& covariance_m2, double weight);
  void copy_rough(std::size_t j);
  void pad();
  void bound_rounding();

  MixtureKernel kernel_;
  MixtureComponents components_;
  MixtureScratch scratch_;
};

}  // namespace cremed
