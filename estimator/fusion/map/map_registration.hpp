// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/fusion/map/target_map.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// A scan registered against a map.
struct MapMatch {
  /// Pose of the vehicle that fits best, relative to the predicted one, in its frame: (x, y, yaw).
  Eigen::Vector3d correction = Eigen::Vector3d::Zero();
  /// Of `correction`; observed information inverted.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  /// Derivative of `correction` by a motion (x, y, yaw about the origin of the predicted frame) of
  /// the targets of each node; they add up to the unit matrix.
  std::array<Eigen::Matrix3d, TargetMap::kNodes> by_node;
  double matched = 0.0;  ///< Number of targets with a partner (sum of probabilities).
  int iterations = 0;
};

class MapRegistration {
 public:
  MapRegistration();

  /// `prior_std`: of the predicted pose, (m, m, rad).
  std::optional<MapMatch> solve(const TargetSet& targets, const TargetMap& map,
                                const Eigen::Vector3d& prior_std);

 private:
  /// A target of the scan and a target of the map that may be the same.
  struct Pair {
    std::uint16_t target;
    std::uint8_t node;
    Eigen::Vector2d at_m;  ///< Of the map's target.
    Symmetric2 information;
    double density;  ///< Of N(0; C).
  };
  struct Sums {
    Eigen::Matrix3d complete = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d missing = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    double matched = 0.0;
  };

  void find_pairs(const TargetSet& targets, const TargetMap& map);
  Sums sum_up(const TargetSet& targets, const Eigen::Vector3d& motion, double outlier_density);
  void sum_by_node(const TargetSet& targets, const Eigen::Vector3d& motion,
                   std::array<Eigen::Matrix3d, TargetMap::kNodes>& sums);

  std::vector<Pair> pairs_;  // Of fixed capacity, ordered by target.
  std::vector<double> weights_;
};

}  // namespace cremed
