// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include "cremed/estimator/fusion/map/map_pairs.hpp"
#include "cremed/estimator/fusion/map/target_map.hpp"
#include "cremed/estimator/scan/pose2.hpp"
#include "cremed/estimator/scan/symmetric2.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// A scan registered against a map. Motions are (x, y, yaw) in the frame of the predicted pose, in
/// m, m, rad; yaw turns about its origin.
struct MapMatch {
  /// The pose that fits best, relative to the predicted one.
  Eigen::Vector3d correction = Eigen::Vector3d::Zero();
  /// Its covariance, with the noise of both targets of each pair.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  /// Derivative of the pose that fits best, without prior, by a motion of each node's targets: the
  /// node's share of the information. The diagonals of all nodes add up to 1.
  std::array<Eigen::Matrix3d, TargetMap::kNodes> by_node;
  /// How far targets, not the search's prior, determine x (0 to 1): of a displacement s along x
  /// `correction` shows x_share s.
  double x_share = 1.0;
  /// Derivative of `correction` by a scale error of all azimuths: true = (1 + error) reported.
  Eigen::Vector3d by_azimuth_scale = Eigen::Vector3d::Zero();
  double matched = 0.0;  ///< Number of the scan's targets with a partner: sum of probabilities.
};

/// Registration of a scan against all scans of a map at once. A target i of the scan, moved by x,
/// is drawn from the Gaussians of all map targets j near it, or from clutter (13 of the README):
///
///     p(r_i) ~ sum_j N(e_ij; C_ij) + n rho,   C_ij = f^2 (S_i + S_j)
///
/// n number of scans in the map, rho density of clutter, f position_std_factor. Gauss-Newton with
/// the observed information (6) of this mixture, where that is positive definite. The predicted
/// pose is a weak prior during the search; the result keeps only the prior of x.
class MapRegistration {
 public:
  /// `position_std_factor`: OdometryOptions.
  explicit MapRegistration(double position_std_factor);

  /// The map must have been placed. None if the targets do not determine y and yaw.
  std::optional<MapMatch> solve(const TargetSet& targets, const TargetMap& map, const Pose2& mount);

 private:
  struct Sums {
    Eigen::Matrix3d complete = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d missing = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    double matched = 0.0;
  };

  void find_pairs(const TargetSet& targets, const TargetMap& map);
  Sums sum_up(const TargetSet& targets, const Eigen::Vector3d& motion, double clutter);
  void add_derivatives(const TargetSet& targets, const TargetMap& map, const Pose2& mount,
                       MapMatch& match) const;

  double variance_factor_;
  MapPairs pairs_;
  // Of each target: its pairs are those from begin_[i] to before begin_[i + 1], and their weights
  // have to be multiplied by share_[i] to be probabilities.
  std::array<std::size_t, kMaxDetections + 1> begin_{};
  std::array<double, kMaxDetections> share_{};
};

}  // namespace cremed
