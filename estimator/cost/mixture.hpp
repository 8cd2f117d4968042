// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "cremed/estimator/cost/outlier_ray.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Max-Sum-Mixture residual of one point against a mixture, with its Jacobian.
/// Source: Pfeifer, Lange, Protzel, RA-L 2021, Max-Sum-Mixture.
struct MixtureResidual {
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();  ///< (whitened error x, y; rest of the sum)
  Eigen::Matrix<double, 3, 2> jacobian = Eigen::Matrix<double, 3, 2>::Zero();  ///< d / d point
  double cost = 0.0;  ///< -log of the mixture at the point, up to a constant.
};

/// The previous scan as a Gaussian mixture, (1) of the README: one component for each target, and
/// the outlier ray.
class Mixture {
 public:
  /// Weight (1 - w_o) / F for each of the F targets, w_o in total for the ray.
  void assign(const TargetSet& targets, const OutlierRay& ray);

  /// The residual of a point in the mixture's frame. Covariances are held fixed in the Jacobian.
  /// The mixture must not be empty. Uses scratch space of the object.
  MixtureResidual evaluate(const Eigen::Vector2d& point_m, const Symmetric2& covariance_m2);

  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  static constexpr std::size_t kCapacity = kMaxDetections + kMaxRayComponents;
  using Column = std::array<double, kCapacity>;

  void push(double x_m, double y_m, const Symmetric2& covariance_m2, double weight);
  void find_distances(const Eigen::Vector2d& point_m, const Symmetric2& covariance_m2);
  void list_near(double least_squared_distance);

  std::size_t size_ = 0;
  double log_damped_size_ = 0.0;  // log(size + damping)
  // Means, covariances and weights of the components.
  Column x_m_{};
  Column y_m_{};
  Column xx_{};
  Column xy_{};
  Column yy_{};
  Column weight_{};
  // Of a point, for each component: e' C^-1 e, 1 / det C, and g = C^-1 e.
  Column squared_distance_{};
  Column inverse_det_{};
  Column gx_{};
  Column gy_{};
  // Components that are not negligible, and their exponentials.
  std::size_t near_count_ = 0;
  std::array<std::size_t, kCapacity> near_{};
  Column exponential_{};
};

}  // namespace cremed
