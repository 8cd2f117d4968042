// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/motion/doppler_velocity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "cremed/estimator/scan/median.hpp"

namespace cremed {
namespace {

/// Tukey's biweight: 95 % efficient for Gaussian residuals; zero weight beyond this many sigma.
constexpr double kTukeySigmas = 4.685;
/// Prior of the offset of all Doppler while weights are computed. Wide enough to have no effect:
/// measured offsets are 0.01 to 0.07 m/s (SharedErrorOptions, OdometryOptions).
constexpr double kOffsetPriorMps = 0.2;
/// Scale of the weights in the first iteration, twice the grid of an ARS408. It shrinks by 0.6 in
/// each iteration down to the noise of Doppler: three iterations to 0.13 m/s.
constexpr double kStartScaleMps = 0.5;
constexpr double kScaleShrinkage = 0.6;
constexpr int kMaxIterations = 12;
/// At most a hundredth of the smallest standard deviation in OdometryOptions
/// (velocity_floor_x_mps).
constexpr double kConvergedMps = 1e-4;
/// Wide enough to include targets that differ by 2.4 m/s, with the noise of an ARS408.
constexpr double kWider = 4.0;
/// Factor on the squared difference in the noise, and the expected squared difference, over the
/// covariance, if all residuals are Gaussian (Tukey's weights: 95 % efficient). Without the
/// difference the front radar alone is off after 10 s by 0.62 % of the path, with it once by 0.51
/// %, with 4 times by 0.49 % (nuScenes, mean).
constexpr double kOfDifference = 4.0;
constexpr double kOfGaussian = 0.05;
/// Three unknowns and one more target for a residual.
constexpr int kMinTargets = 4;
/// Median of |residual| over sigma, for a Gaussian.
constexpr double kMedianPerStd = 0.6745;

/// Pairs of targets that search() tries. If half of the targets are static, all 64 pairs have a
/// moving target with probability 10^-8 (0.75^64).
constexpr std::size_t kTrials = 64;
/// Sine of the angle between the lines of sight of a pair. Below 9 degrees noise is amplified more
/// than 6 times.
constexpr double kMinSine = 0.15;

double residual(const Target& target, const Eigen::Vector3d& solution) {
  return target.doppler_mps - expected_doppler_mps(target, solution.x(), solution.y()) -
         solution.z();
}

double weight(double residual, double scale) {
  const double u = residual / (kTukeySigmas * scale);
  const double inside = 1.0 - u * u;
  return inside > 0.0 ? inside * inside : 0.0;
}

struct Sums {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  int targets = 0;

  [[nodiscard]] Eigen::Matrix2d inverse() const {
    return information.topLeftCorner<2, 2>().inverse();
  }
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

/// Truncated sum of squared residuals.
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
    scale = std::max(std_mps, kScaleShrinkage * scale);
  }
  DopplerVelocity result;
  result.residual_std_mps =
      median_residual(targets, solution, kTukeySigmas * std_mps) / kMedianPerStd;
  const Eigen::Matrix2d inverse = sums.inverse();
  result.velocity_mps = inverse * sums.weighted.head<2>();
  result.per_offset = inverse * sums.information.topRightCorner<2, 1>();
  result.covariance = std_mps * std_mps * inverse;
  const Sums wider = sum_up(targets, solution, kWider * std_mps);
  result.difference_mps = wider.inverse() * wider.weighted.head<2>() - result.velocity_mps;
  result.targets = sums.targets;
  return result;
}

Eigen::Matrix2d DopplerVelocity::covariance_in_traffic() const {
  return (1.0 - kOfDifference * kOfGaussian) * covariance +
         kOfDifference * difference_mps * difference_mps.transpose();
}

double DopplerVelocityEstimator::median_residual(const TargetSet& targets,
                                                 const Eigen::Vector3d& solution,
                                                 double max_residual_mps) {
  auto* last = scratch_.data();
  for (const Target& target : targets) {
    const double size = std::abs(residual(target, solution));
    if (size < max_residual_mps) {
      *last++ = size;
    }
  }
  return median_or(0.0, scratch_.data(), last);
}

}  // namespace cremed
