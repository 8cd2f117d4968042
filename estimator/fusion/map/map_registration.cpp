// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/map/map_registration.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "cremed/estimator/fusion/tune.hpp"
#include "cremed/estimator/scan/rotation.hpp"
#include "cremed/estimator/scan/squared.hpp"

namespace cremed {
namespace {

constexpr std::size_t kMaxPairs = 32768;
constexpr double kRadiusM = TargetMap::kCellM;

/// Derivative of a point by the motion: J = [I, (-y, x)].
Eigen::Vector3d gradient_of(const Eigen::Vector2d& force, const Eigen::Vector2d& at) {
  return {force.x(), force.y(), at.x() * force.y() - at.y() * force.x()};
}

Eigen::Matrix3d information_of(const Symmetric2& w, const Eigen::Vector2d& at) {
  const Eigen::Vector2d across(-at.y(), at.x());
  const Eigen::Vector2d wa = w * across;
  Eigen::Matrix3d result;
  result << w.xx, w.xy, wa.x(), w.xy, w.yy, wa.y(), wa.x(), wa.y(), across.dot(wa);
  return result;
}

}  // namespace

MapRegistration::MapRegistration() {
  pairs_.reserve(kMaxPairs);
  weights_.reserve(kMaxPairs);
}

void MapRegistration::find_pairs(const TargetSet& targets, const TargetMap& map) {
  static const double kScatter = squared(tune("scatter", 1.0));
  static const double kFloor = squared(tune("posfloor", 0.0));
  static const double kGlide = squared(tune("glide", 0.0));
  static const double kGlideAll = squared(tune("glideall", 0.0));
  static const double kMapShare = tune("mapshare", 1.0);
  pairs_.clear();
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Target& target = targets[i];
    map.for_each_near(target.x_m, target.y_m, [&](std::size_t j) {
      const TargetMap::Placed& placed = map.placed()[j];
      const double dx = placed.x_m - target.x_m;
      const double dy = placed.y_m - target.y_m;
      if (pairs_.size() == kMaxPairs || dx * dx + dy * dy > kRadiusM * kRadiusM) {
        return;
      }
      const Symmetric2 c = kScatter * (target.covariance_m2 + kMapShare * placed.covariance_m2) +
                           Symmetric2{kFloor, 0, kFloor} + (squared(map.way_m(placed.node)) * (kGlideAll + kGlide * squared(squared(target.sin_bearing)))) * Symmetric2{1.0, 0.0, 0.0};
      pairs_.push_back({static_cast<std::uint16_t>(i),
                        placed.node,
                        {placed.x_m, placed.y_m},
                        c.inverse(),
                        1.0 / (2.0 * std::numbers::pi * std::sqrt(c.determinant()))});
    });
  }
  weights_.resize(pairs_.size());
}

MapRegistration::Sums MapRegistration::sum_up(const TargetSet& targets,
                                              const Eigen::Vector3d& motion,
                                              double outlier_density) {
  Sums sums;
  const Rotation turn(motion.z());
  for (std::size_t begin = 0; begin < pairs_.size();) {
    const Target& target = targets[pairs_[begin].target];
    const Eigen::Vector2d turned = turn * Eigen::Vector2d(target.x_m, target.y_m);
    const Eigen::Vector2d at = turned + motion.head<2>();
    double sum = outlier_density;
    std::size_t end = begin;
    for (; end < pairs_.size() && pairs_[end].target == pairs_[begin].target; ++end) {
      const Eigen::Vector2d e = at - pairs_[end].at_m;
      weights_[end] = pairs_[end].density * std::exp(-0.5 * e.dot(pairs_[end].information * e));
      sum += weights_[end];
    }
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (std::size_t k = begin; k < end; ++k) {
      const double w = weights_[k] / sum;
      weights_[k] = w;
      const Eigen::Vector2d e = at - pairs_[k].at_m;
      const Eigen::Vector3d g = gradient_of(pairs_[k].information * e, turned);
      sums.complete += w * information_of(pairs_[k].information, turned);
      sums.missing += w * g * g.transpose();
      mean += w * g;
      sums.matched += w;
    }
    sums.missing -= mean * mean.transpose();
    sums.gradient += mean;
    begin = end;
  }
  return sums;
}

void MapRegistration::sum_by_node(const TargetSet& targets, const Eigen::Vector3d& motion,
                                  std::array<Eigen::Matrix3d, TargetMap::kNodes>& sums) {
  for (Eigen::Matrix3d& sum : sums) {
    sum.setZero();
  }
  const Rotation turn(motion.z());
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const Target& target = targets[pairs_[k].target];
    const Eigen::Vector2d turned = turn * Eigen::Vector2d(target.x_m, target.y_m);
    sums[pairs_[k].node] += weights_[k] * information_of(pairs_[k].information, turned);
  }
}

std::optional<MapMatch> MapRegistration::solve(const TargetSet& targets, const TargetMap& map,
                                               const Eigen::Vector3d& prior_std) {
  static const double kOutlier = tune("outlier", 0.02);
  static const int kIterations = static_cast<int>(tune("iters", 8));
  static const bool kNewton = tune("newton", 1) != 0;
  find_pairs(targets, map);
  const double outlier_density = kOutlier * map.scans();
  const Eigen::Matrix3d prior = prior_std.cwiseAbs2().cwiseInverse().asDiagonal();
  MapMatch match;
  Eigen::Vector3d& motion = match.correction;
  Sums sums;
  for (match.iterations = 1;; ++match.iterations) {
    sums = sum_up(targets, motion, outlier_density);
    Eigen::Matrix3d information = sums.complete + prior;
    if (kNewton) {
      const Eigen::Matrix3d observed = information - sums.missing;
      const Eigen::LLT<Eigen::Matrix3d> test(observed - 0.2 * information);
      if (test.info() == Eigen::Success) {
        information = observed;
      }
    }
    const Eigen::LLT<Eigen::Matrix3d> factor(information);
    if (factor.info() != Eigen::Success) {
      return std::nullopt;
    }
    const Eigen::Vector3d step = -factor.solve(sums.gradient + prior * motion);
    if (match.iterations == kIterations || step.dot(information * step) < 1e-4) {
      break;
    }
    motion += step;
  }
  // Without the prior of y and yaw: linearised at the solution. That of x stays.
  Eigen::Matrix3d observed = sums.complete - sums.missing;
  Eigen::Matrix3d complete = sums.complete;
  complete(0, 0) += prior(0, 0);
  observed(0, 0) += prior(0, 0);
  Eigen::Vector3d gradient = sums.gradient;
  gradient.x() += prior(0, 0) * motion.x();
  if (Eigen::LLT<Eigen::Matrix3d>(observed - 0.1 * complete).info() != Eigen::Success) {
    return std::nullopt;
  }
  motion -= observed.inverse() * gradient;
  match.covariance = observed.inverse();
  match.matched = sums.matched;
  sum_by_node(targets, motion, match.by_node);
  const Eigen::Matrix3d inverse = complete.inverse();
  for (Eigen::Matrix3d& by : match.by_node) {
    by = (inverse * by).eval();
  }
  return match;
}

}  // namespace cremed
