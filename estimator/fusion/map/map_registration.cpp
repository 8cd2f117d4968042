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

/// Bounds the work; targets beyond have no partner. RadarScenes, with 200 targets a scan, has up to
/// 10 000.
constexpr std::size_t kMaxPairs = 32768;
/// Clutter, 1/m^2: the density of an ARS408's targets within 50 m. From 0.005 to 0.1 the yaw error
/// on scenes 0061, 0103, 1094 and RadarScenes 105 changes by less than a tenth.
constexpr double kClutterPerM2 = 0.02;
/// Of the predicted pose, which is better: 0.05 m, 0.1 degrees. It keeps the search in its basin.
const Eigen::Vector3d kPriorStd(0.1, 0.3, 0.02);
/// Most matches of RadarScenes use all. With steps 1.5 or 1.8 times as long, nearer to the optimum,
/// its path errs by 0.78 and 0.81 % instead of 0.74, and those of nuScenes not otherwise.
constexpr int kMaxIterations = 8;
/// Squared step over the standard deviation: 1 % of it.
constexpr double kConverged = 1e-4;
/// Squared distance in sigmas beyond which a pair's weight, 4e-6 of its greatest, is left out.
constexpr double kNoPartner = 25.0;
/// The same from the predicted pose, farther than any correction reaches: two thirds of the pairs
/// of RadarScenes are left, and the same results.
constexpr double kOutOfReach = 100.0;
/// Least share of the complete information, in every direction, that is left after the missing
/// information, for a step and for a result. Where less is left neighbours are confused.
constexpr double kMinObservedShareOfStep = 0.2;
constexpr double kMinObservedShare = 0.1;

/// J'f of a force f on a point, with J = [1, 0, -y; 0, 1, x], the derivative of the point.
Eigen::Vector3d gradient_of(const Eigen::Vector2d& force, const Eigen::Vector2d& at) {
  return {force.x(), force.y(), at.x() * force.y() - at.y() * force.x()};
}

/// J'WJ
Eigen::Matrix3d information_of(const Symmetric2& w, const Eigen::Vector2d& at) {
  const Eigen::Vector2d across(-at.y(), at.x());
  const Eigen::Vector2d wa = w * across;
  Eigen::Matrix3d result;
  result << w.xx, w.xy, wa.x(), w.xy, w.yy, wa.y(), wa.x(), wa.y(), across.dot(wa);
  return result;
}

/// v v'
Symmetric2 outer(const Eigen::Vector2d& v) { return {v.x() * v.x(), v.x() * v.y(), v.y() * v.y()}; }

bool is_positive(const Eigen::Matrix3d& matrix) {
  return Eigen::LLT<Eigen::Matrix3d>(matrix).info() == Eigen::Success;
}

}  // namespace

MapRegistration::MapRegistration(double position_std_factor)
    : variance_factor_(squared(position_std_factor)) {
  pairs_.reserve(kMaxPairs);
}

void MapRegistration::find_pairs(const TargetSet& targets, const TargetMap& map) {
  pairs_.clear();
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Target& target = targets[i];
    const Eigen::Vector2d at(target.x_m, target.y_m);
    map.for_each_near(target.x_m, target.y_m, [&](const TargetMap::Placed& placed) {
      const Eigen::Vector2d e = placed.at_m - at;
      if (pairs_.size() == kMaxPairs || e.squaredNorm() > squared(TargetMap::kCellM)) {
        return;
      }
      const Symmetric2 c = variance_factor_ * (target.covariance_m2 + placed.covariance_m2);
      const Symmetric2 information = c.inverse();
      if (information.quadratic(e.x(), e.y()) > kOutOfReach) {
        return;
      }
      const double density = 1.0 / (2.0 * std::numbers::pi * std::sqrt(c.determinant()));
      pairs_.push_back({static_cast<std::uint16_t>(i), placed.node, placed.at_m, placed.azimuth_rad,
                        information, density, 0.0});
    });
  }
}

/// Sets the weights at `motion`, and sums information and gradient of -log p.
MapRegistration::Sums MapRegistration::sum_up(const TargetSet& targets,
                                              const Eigen::Vector3d& motion, double clutter) {
  Sums sums;
  const Rotation turn(motion.z());
  for (auto begin = pairs_.begin(); begin != pairs_.end();) {
    const Target& target = targets[begin->target];
    const Eigen::Vector2d turned = turn * Eigen::Vector2d(target.x_m, target.y_m);
    const Eigen::Vector2d at = turned + motion.head<2>();
    double sum = clutter;
    auto end = begin;
    for (; end != pairs_.end() && end->target == begin->target; ++end) {
      const double squared_distance =
          end->information.quadratic(at.x() - end->at_m.x(), at.y() - end->at_m.y());
      end->weight =
          squared_distance < kNoPartner ? end->density * std::exp(-0.5 * squared_distance) : 0.0;
      sum += end->weight;
    }
    // Of the point of this target, which all pairs share.
    Symmetric2 complete;
    Symmetric2 missing;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (; begin != end; ++begin) {
      if (begin->weight > 0.0) {
        begin->weight /= sum;
        const Eigen::Vector2d force = begin->information * (at - begin->at_m);
        complete = complete + begin->weight * begin->information;
        missing = missing + begin->weight * outer(force);
        mean += begin->weight * force;
        sums.matched += begin->weight;
      }
    }
    sums.complete += information_of(complete, turned);
    sums.missing += information_of(missing + -1.0 * outer(mean), turned);
    sums.gradient += gradient_of(mean, turned);
  }
  return sums;
}

void MapRegistration::add_derivatives(const TargetSet& targets, const TargetMap& map,
                                      const Pose2& mount, MapMatch& match) const {
  match.by_node.fill(Eigen::Matrix3d::Zero());
  // Of all at the same points as that of each node.
  Eigen::Matrix3d complete = Eigen::Matrix3d::Zero();
  complete(0, 0) = 1.0 / squared(kPriorStd.x());
  const Eigen::Vector2d radar_m(mount.x_m, mount.y_m);
  for (const Pair& pair : pairs_) {
    const Target& target = targets[pair.target];
    const Eigen::Vector2d at(target.x_m, target.y_m);
    const Eigen::Vector2d moved = azimuth_rad(target, mount) * (at - radar_m) -
                                  pair.azimuth_rad * (pair.at_m - map.radar_m(pair.node));
    const Eigen::Matrix3d information = pair.weight * information_of(pair.information, at);
    match.by_node[pair.node] += information;
    complete += information;
    match.by_azimuth_scale +=
        pair.weight * gradient_of(pair.information * Eigen::Vector2d(-moved.y(), moved.x()), at);
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
  const double clutter = kClutterPerM2 * map.scans();
  const Eigen::Matrix3d prior = kPriorStd.cwiseAbs2().cwiseInverse().asDiagonal();
  MapMatch match;
  Eigen::Vector3d& motion = match.correction;
  Sums sums = sum_up(targets, motion, clutter);
  for (int i = 0; i < kMaxIterations; ++i) {
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
  if (!is_positive(observed - kMinObservedShare * complete)) {
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
