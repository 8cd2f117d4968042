// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "estimator/outlier_ray.hpp"
#include "estimator/target_set.hpp"

namespace cremed {

/// Max-Sum-Mixture residual of one point against a mixture, with its Jacobian.
/// Source: Pfeifer, Lange, Protzel, RA-L 2021, Max-Sum-Mixture.
struct MixtureResidual {
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();  ///< (whitened error x, y; rest of the sum)
  Eigen::Matrix<double, 3, 2> jacobian = Eigen::Matrix<double, 3, 2>::Zero();  ///< d / d point
  double cost = 0.0;          ///< -log of the mixture at the point, up to a constant of the point.
  std::size_t component = 0;  ///< The component that explains the point best.
};

/// The previous scan as a Gaussian mixture: one component a target, and the outlier ray.
/// Structure of arrays, because every target is compared with every component.
class Mixture {
 public:
  static constexpr std::size_t kMaxComponents = kMaxDetections + kMaxRayComponents;

  /// Weight (1 - w_o) / F for each of the F targets, w_o in all for the ray.
  void assign(const TargetSet& targets, const OutlierRay& ray);

  /// Residual of a point with its own covariance, both in the mixture's frame. The Jacobian holds
  /// the covariances fixed. The mixture must not be empty. Uses scratch space of the object.
  MixtureResidual evaluate(const Eigen::Vector2d& point_m, const Symmetric2& covariance_m2);

  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  using Row = std::array<double, kMaxComponents>;

  void push(double x_m, double y_m, const Symmetric2& covariance_m2, double weight);
  void compute_distances(const Eigen::Vector2d& point_m, const Symmetric2& covariance_m2);
  std::size_t collect_active(double nearest);
  void compute_likelihoods(std::size_t active_count);

  std::size_t size_ = 0;
  alignas(64) Row x_m_{};
  alignas(64) Row y_m_{};
  alignas(64) Row xx_{};
  alignas(64) Row xy_{};
  alignas(64) Row yy_{};
  alignas(64) Row weight_{};
  // Scratch of evaluate(): one entry a component.
  alignas(64) Row inverse_determinant_{};  // 1 / det C_ij
  alignas(64) Row squared_distance_{};     // e' C_ij^-1 e
  // Scratch of evaluate(): one entry an active component.
  std::array<std::size_t, kMaxComponents> active_{};
  alignas(64) Row exponent_{};
  alignas(64) Row likelihood_{};  // q_ij relative to the nearest component's exponential
};

}  // namespace cremed
