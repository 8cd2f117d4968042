// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/ndt_map.hpp"

#include <cmath>

#include <Eigen/LU>

namespace cremed {
namespace {

constexpr int kGrids = 4;
/// One point has no distribution.
constexpr int kLeastPoints = 2;

}  // namespace

/// Index of the cell of a point.
std::int64_t NdtMap::key(int grid, const Eigen::Vector2d& point_m) const {
  const Eigen::Vector2d shift(grid % 2 == 0 ? 0.0 : 0.5, grid < 2 ? 0.0 : 0.5);
  const Eigen::Vector2d cell = point_m / cell_m_ + shift;
  const auto column = static_cast<std::int64_t>(std::floor(cell.x()));
  const auto row = static_cast<std::int64_t>(std::floor(cell.y()));
  return ((column + (std::int64_t{1} << 24)) << 32 | (row + (std::int64_t{1} << 24))) * kGrids +
         grid;
}

void NdtMap::add(const UncertainPoint& point) {
  for (int grid = 0; grid < kGrids; ++grid) {
    Cell& cell = cells_[key(grid, point.position_m)];
    ++cell.points;
    cell.sum_m += point.position_m;
    cell.squares_m2 += point.position_m * point.position_m.transpose() + point.covariance_m2;
  }
}

void NdtMap::remove(const UncertainPoint& point) {
  for (int grid = 0; grid < kGrids; ++grid) {
    const auto cell = cells_.find(key(grid, point.position_m));
    if (--cell->second.points == 0) {
      cells_.erase(cell);
      continue;
    }
    cell->second.sum_m -= point.position_m;
    cell->second.squares_m2 -=
        point.position_m * point.position_m.transpose() + point.covariance_m2;
  }
}

void NdtMap::add_point(const UncertainPoint& point, const Eigen::Vector2d& centre_m,
                       Equations& equations) const {
  const Eigen::Vector2d arm = point.position_m - centre_m;
  Eigen::Matrix<double, 2, 3> by_motion;
  by_motion << 1.0, 0.0, -arm.y(), 0.0, 1.0, arm.x();
  for (int grid = 0; grid < kGrids; ++grid) {
    const auto found = cells_.find(key(grid, point.position_m));
    if (found == cells_.end() || found->second.points < kLeastPoints) {
      continue;
    }
    const Cell& cell = found->second;
    const Eigen::Vector2d mean = cell.sum_m / cell.points;
    const Eigen::Matrix2d covariance =
        cell.squares_m2 / cell.points - mean * mean.transpose() + point.covariance_m2;
    const Eigen::Matrix2d information = covariance.inverse();
    const Eigen::Vector2d error = mean - point.position_m;
    const double likelihood = std::exp(-0.5 * error.dot(information * error)) / kGrids;
    equations.information += likelihood * by_motion.transpose() * information * by_motion;
    equations.right += likelihood * by_motion.transpose() * information * error;
    equations.likelihood += likelihood;
  }
}

}  // namespace cremed
