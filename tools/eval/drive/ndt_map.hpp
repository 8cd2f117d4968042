// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <unordered_map>

#include <Eigen/Core>

namespace cremed {

/// A point with its uncertainty.
struct UncertainPoint {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Zero();
};

/// Normal distributions transform: each cell has the Gaussian of its points. Four grids, shifted by
/// half a cell, overlap (Biber and Strasser, IROS 2003). A point counts with its own covariance
/// (Kung et al., ICRA 2021).
class NdtMap {
 public:
  explicit NdtMap(double cell_m) : cell_m_(cell_m) {}

  void add(const UncertainPoint& point);
  /// Undoes add().
  void remove(const UncertainPoint& point);

  /// Normal equations of a small motion (x, y, yaw) of the points about `centre`, each weighted by
  /// its likelihood.
  struct Equations {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    double likelihood = 0.0;  ///< Sum over points.
  };
  void add_point(const UncertainPoint& point, const Eigen::Vector2d& centre_m,
                 Equations& equations) const;

 private:
  struct Cell {
    int points = 0;
    Eigen::Vector2d sum_m = Eigen::Vector2d::Zero();
    Eigen::Matrix2d squares_m2 = Eigen::Matrix2d::Zero();  // With the points' own covariances.
  };

  [[nodiscard]] std::int64_t key(int grid, const Eigen::Vector2d& point_m) const;

  double cell_m_;
  std::unordered_map<std::int64_t, Cell> cells_;
};

}  // namespace cremed
