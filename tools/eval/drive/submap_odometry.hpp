// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include "tools/eval/drive/kellner_velocity.hpp"
#include "tools/eval/drive/radar_sweep.hpp"
#include "tools/eval/drive/true_trajectory.hpp"

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

  /// `count` -1 takes it out again.
  void add(const UncertainPoint& point, int count = 1);

  /// Normal equations of a small motion (x, y, yaw) of the points about `centre`, each weighted by
  /// its likelihood.
  struct Equations {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
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

/// Size of the map.
struct SubmapOptions {
  std::size_t sweeps = 10;
  /// With ten sweeps, larger cells blur what an ARS408 resolves; smaller ones hold one point each.
  double cell_m = 3.0;
};

/// Matches each sweep with a map of the last ones, after Kung et al., "A normal distribution
/// transform-based radar odometry designed for scanning and automotive radars" (ICRA 2021). Uses
/// only targets that are static by Doppler (Kellner), with the motion between scans compensated by
/// the velocity; the velocity gives the initial guess and a measurement.
class SubmapOdometry {
 public:
  explicit SubmapOdometry(const SubmapOptions& options) : options_(options), map_(options.cell_m) {}

  struct Result {
    Eigen::Vector3d motion = Eigen::Vector3d::Zero();  ///< Since the last sweep, in its frame.
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  };
  /// `motion`: from the velocity, since the last sweep `dt_s` ago.
  Result update(const Sweep& sweep, const KellnerVelocity& velocity, const Eigen::Vector3d& motion,
                double dt_s);

 private:
  void add_to_map(const std::vector<UncertainPoint>& placed_points);

  SubmapOptions options_;
  NdtMap map_;  // Of sweeps_.
  Pose2 pose_;
  std::deque<std::vector<UncertainPoint>> sweeps_;  // In the frame of the first pose.
};

}  // namespace cremed
