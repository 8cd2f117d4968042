// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/motion/doppler_velocity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "cremed/estimator/motion/median.hpp"

namespace cremed {
namespace {

/// Tukey's biweight: 95 % efficient on Gaussian residuals, nothing beyond so many sigma.
constexpr double kTukey = 4.685;
/// Offset of all Doppler while weights are found: as wide as it takes not to matter, for what is
/// measured is 0.01 to 0.07 m/s (SharedErrorOptions, OdometryOptions).
constexpr double kOffsetPriorMps = 0.2;
/// Residuals are judged by this scale first, twice the grid of an ARS408, and then by 0.6 of it and
/// so on down to their own: three steps to 0.13 m/s.
constexpr double kStartScaleMps = 0.5;
constexpr double kNarrowing = 0.6;
constexpr int kMaxIterations = 12;
/// A hundredth of the best covariance that OdometryOptions allows (velocity_floor_x_mps), and less.
constexpr double kConvergedMps = 1e-4;
/// Two directions and one more, to have a residual at all.
constexpr int kMinTargets = 4;
/// Median of |residual| over sigma, for a Gaussian.
constexpr double kMedianPerStd = 0.6745;

/// Pairs of targets that search() asks. If half of the targets stand still, none of 64 pairs is of
/// two such once in 10^8 (0.75^64).
constexpr std::size_t kTrials = 64;
/// Between the lines of sight of a pair: nearer than 9 degrees noise counts for more than 6 times.
constexpr double kMinSine = 0.15;

double residual(const Target& target, const Eigen::Vector3d& solution) {
  return target.doppler_mps + target.cos_bearing * solution.x() +
         target.sin_bearing * solution.y() - solution.z();
}

double weight(double residual, double scale) {
  const double u = residual / (kTukey * scale);
  const double inside = 1.0 - u * u;
  return inside > 0.0 ? inside * inside : 0.0;
}

struct Sums {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  int targets = 0;
};

Sums sum_up(const TargetSet& targets, const Eigen::Vector3d& solution, double scale) {
  Sums sums;
  for (const Target& target : targets) {
    const double w = weight(residual(target, solution), scale);
    if (w > 0.0) {
      const Eigen::Vector3d row(-target.cos_bearing, -target.sin_bearing, 1.0);
      sums.information.noalias() += w * row * row.transpose();
      sums.weighted += w * target.doppler_mps * row;
      ++sums.targets;
    }
  }
  return sums;
}

/// Sum of squared residuals, each limited.
double search_cost(const TargetSet& targets, const Eigen::Vector2d& velocity) {
  const Eigen::Vector3d solution(velocity.x(), velocity.y(), 0.0);
  double cost = 0.0;
  for (const Target& target : targets) {
    const double r = residual(target, solution);
    cost += std::min(r * r, kStartScaleMps * kStartScaleMps);
  }
  return cost;
}

}  // namespace

Eigen::Vector2d DopplerVelocityEstimator::search(const TargetSet& targets) {
  const std::size_t n = targets.size();
  Eigen::Vector2d best = Eigen::Vector2d::Zero();
  double best_cost = search_cost(targets, best);
  for (std::size_t k = 0; n > 1 && k < kTrials; ++k) {
    const Target& a = targets[k * 7919 % n];
    const Target& b = targets[(k * 7919 + 1 + k * 104729 % (n - 1)) % n];
    const double sine = a.cos_bearing * b.sin_bearing - a.sin_bearing * b.cos_bearing;
    if (std::abs(sine) < kMinSine) {
      continue;
    }
    const Eigen::Vector2d velocity(
        (a.sin_bearing * b.doppler_mps - b.sin_bearing * a.doppler_mps) / sine,
        (b.cos_bearing * a.doppler_mps - a.cos_bearing * b.doppler_mps) / sine);
    const double cost = search_cost(targets, velocity);
    if (cost < best_cost) {
      best_cost = cost;
      best = velocity;
    }
  }
  return best;
}

std::optional<DopplerVelocity> DopplerVelocityEstimator::fit(const TargetSet& targets,
                                                             const Eigen::Vector2d& start,
                                                             double std_mps) {
  Eigen::Vector3d solution(start.x(), start.y(), 0.0);
  double scale = std::max(kStartScaleMps, std_mps);
  Sums sums;
  for (int i = 0; i < kMaxIterations; ++i) {
    sums = sum_up(targets, solution, scale);
    Eigen::Matrix3d information = sums.information;
    information(2, 2) += scale * scale / (kOffsetPriorMps * kOffsetPriorMps);
    const Eigen::LDLT<Eigen::Matrix3d> factor(information);
    if (sums.targets < kMinTargets || factor.vectorD().minCoeff() < 1e-6) {
      return std::nullopt;
    }
    const Eigen::Vector3d next = factor.solve(sums.weighted);
    const double change = (next - solution).norm();
    solution = next;
    if (scale <= std_mps && change < kConvergedMps) {
      break;
    }
    scale = std::max(std_mps, kNarrowing * scale);
  }
  DopplerVelocity result;
  result.residual_std_mps = median_residual(targets, solution, kTukey * std_mps) / kMedianPerStd;
  const Eigen::Matrix2d inverse = sums.information.topLeftCorner<2, 2>().inverse();
  result.velocity_mps = inverse * sums.weighted.head<2>();
  result.per_offset = inverse * sums.information.topRightCorner<2, 1>();
  result.covariance = std_mps * std_mps * inverse;
  result.targets = sums.targets;
  return result;
}

double DopplerVelocityEstimator::median_residual(const TargetSet& targets,
                                                 const Eigen::Vector3d& solution, double most) {
  auto* last = scratch_.data();
  for (const Target& target : targets) {
    const double size = std::abs(residual(target, solution));
    if (size < most) {
      *last++ = size;
    }
  }
  return median_or(0.0, scratch_.data(), last);
}

}  // namespace cremed
