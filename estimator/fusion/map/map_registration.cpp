// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/map/map_registration.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "cremed/estimator/scan/rotation.hpp"
#include "cremed/estimator/scan/squared.hpp"

namespace cremed {
namespace {

/// Clutter, 1/m^2: the density of an ARS408's targets within 50 m. From 0.005 to 0.1 the yaw error
/// on scenes 0061, 0103, 1094 and RadarScenes 105 changes by less than a tenth.
constexpr double kMapClutterPerM2 = 0.02;
/// Of the prior, the predicted pose, which is better: 0.05 m, 0.1 degrees. The prior keeps the
/// search in its basin.
const Eigen::Vector3d kPriorStd(0.1, 0.3, 0.02);
/// Most matches on RadarScenes use all steps. With steps 1.5 or 1.8 times as long, which end nearer
/// to the optimum, its path errs by 0.78 and 0.81 % instead of 0.74, and those of nuScenes are the
/// same.
constexpr int kMaxSteps = 8;
/// Squared length of the last step in standard deviations: 1 %.
constexpr double kConverged = 1e-4;
constexpr double kTwoPi = 2.0 * std::numbers::pi;
/// Squared distance in sigmas from the predicted pose beyond which a pair is left out: 5 sigma, and
/// two that a correction may take away. With 10 sigma the odometry is the same to 5e-4 sigma.
constexpr double kOutOfReach = 49.0;
/// Least share of the complete information, in every direction, that is left when the missing
/// information is subtracted, for a step and for a result. With less, neighbours are confused.
constexpr double kMinObservedShareOfStep = 0.2;
constexpr double kMinObservedShareOfResult = 0.1;

/// v v'
Symmetric2 outer(const Eigen::Vector2d& v) { return {v.x() * v.x(), v.x() * v.y(), v.y() * v.y()}; }

bool is_positive(const Eigen::Matrix3d& matrix) {
  return Eigen::LLT<Eigen::Matrix3d>(matrix).info() == Eigen::Success;
}

}  // namespace

MapRegistration::MapRegistration(double position_std_factor)
    : variance_factor_(squared(position_std_factor)) {}

void MapRegistration::find_pairs(const TargetSet& targets, const TargetMap& map) {
  pairs_.clear();
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Target& target = targets[i];
    const Eigen::Vector2d at(target.x_m, target.y_m);
    begin_[i] = pairs_.size();
    map.for_each_near(target.x_m, target.y_m, [&](const TargetMap::Placed& placed) {
      const Eigen::Vector2d e = placed.at_m - at;
      if (pairs_.is_full() || e.squaredNorm() > squared(TargetMap::kCellM)) {
        return;
      }
      const Symmetric2 c = variance_factor_ * (target.covariance_m2 + placed.covariance_m2);
      const Symmetric2 information = c.inverse();
      if (information.quadratic(e.x(), e.y()) <= kOutOfReach) {
        pairs_.add(placed, information, std::sqrt(information.determinant()) / kTwoPi);
      }
    });
    pairs_.pad();
  }
  begin_[targets.size()] = pairs_.size();
}

/// Sums information and gradient of -log p at `motion`.
MapRegistration::Sums MapRegistration::sum_up(const TargetSet& targets,
                                              const Eigen::Vector3d& motion, double clutter) {
  Sums sums;
  const Rotation turn(motion.z());
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (begin_[i] == begin_[i + 1]) {
      continue;
    }
    const Eigen::Vector2d turned = turn * Eigen::Vector2d(targets[i].x_m, targets[i].y_m);
    const PairSums pairs = pairs_.sum_up(begin_[i], begin_[i + 1], turned + motion.head<2>());
    const double share = 1.0 / (clutter + pairs.weight);
    const Eigen::Vector2d force = share * pairs.force;
    sums.complete += point_information(share * pairs.information, turned);
    sums.missing += point_information(share * pairs.squared_force + -1.0 * outer(force), turned);
    sums.gradient += along_states(force, turned);
    sums.matched += share * pairs.weight;
    share_[i] = share;
  }
  return sums;
}

void MapRegistration::add_derivatives(const TargetSet& targets, const TargetMap& map,
                                      const Pose2& mount, MapMatch& match) const {
  match.by_node.fill(Eigen::Matrix3d::Zero());
  // Information of all pairs, at the same points as that of each node.
  Eigen::Matrix3d complete = Eigen::Matrix3d::Zero();
  complete(0, 0) = 1.0 / squared(kPriorStd.x());
  const Eigen::Vector2d radar_m(mount.x_m, mount.y_m);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Eigen::Vector2d at(targets[i].x_m, targets[i].y_m);
    const Eigen::Vector2d moved = azimuth_rad(targets[i], mount) * (at - radar_m);
    for (std::size_t k = begin_[i]; k < begin_[i + 1]; ++k) {
      if (pairs_.weight(k) == 0.0) {
        continue;
      }
      const double probability = share_[i] * pairs_.weight(k);
      const std::uint8_t node = pairs_.node(k);
      const Eigen::Vector2d more_moved =
          moved - pairs_.azimuth_rad(k) * (pairs_.at_m(k) - map.radar_m(node));
      const Eigen::Matrix3d information =
          probability * point_information(pairs_.information(k), at);
      match.by_node[node] += information;
      complete += information;
      match.by_azimuth_scale +=
          probability *
          along_states(pairs_.information(k) * Eigen::Vector2d(-more_moved.y(), more_moved.x()),
                       at);
    }
  }
  const Eigen::Matrix3d inverse = complete.inverse();
  const double x_share = 1.0 - inverse(0, 0) / squared(kPriorStd.x());
  for (Eigen::Matrix3d& by : match.by_node) {
    by = (inverse * by).eval();
    by(0, 0) /= x_share;
  }
  match.x_share = 1.0 - match.covariance(0, 0) / squared(kPriorStd.x());
  match.by_azimuth_scale = (inverse * match.by_azimuth_scale).eval();
}

std::optional<MapMatch> MapRegistration::solve(const TargetSet& targets, const TargetMap& map,
                                               const Pose2& mount) {
  find_pairs(targets, map);
  const double clutter = kMapClutterPerM2 * map.scans();
  const Eigen::Matrix3d prior = kPriorStd.cwiseAbs2().cwiseInverse().asDiagonal();
  MapMatch match;
  Eigen::Vector3d& motion = match.correction;
  Sums sums = sum_up(targets, motion, clutter);
  for (int i = 0; i < kMaxSteps; ++i) {
    const Eigen::Matrix3d complete = sums.complete + prior;
    const Eigen::Matrix3d observed = complete - sums.missing;
    const bool is_observed = is_positive(observed - kMinObservedShareOfStep * complete);
    const Eigen::Matrix3d& information = is_observed ? observed : complete;
    const Eigen::Vector3d step = -information.llt().solve(sums.gradient + prior * motion);
    if (!(step.dot(information * step) >= kConverged)) {
      break;
    }
    motion += step;
    sums = sum_up(targets, motion, clutter);
  }
  Eigen::Matrix3d complete = sums.complete;
  complete(0, 0) += prior(0, 0);
  const Eigen::Matrix3d observed = complete - sums.missing;
  if (!is_positive(observed - kMinObservedShareOfResult * complete)) {
    return std::nullopt;
  }
  match.covariance = observed.inverse();
  sums.gradient.x() += prior(0, 0) * motion.x();
  motion -= match.covariance * sums.gradient;
  match.matched = sums.matched;
  add_derivatives(targets, map, mount, match);
  return match;
}

}  // namespace cremed
