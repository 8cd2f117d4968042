// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/kellner_velocity.hpp"

#include <cmath>
#include <random>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace cremed {
namespace {

/// With half of the targets static, a sample of three is good once in eight: all samples fail once
/// in 10^11 scans.
constexpr int kSamples = 200;
/// About three standard deviations of an ARS408's Doppler.
constexpr double kMaxResidualMps = 0.3;
constexpr std::size_t kLeastTargets = 10;
constexpr int kRefinements = 3;

double residual_mps(const SweepTarget& target, const Eigen::Vector3d& twist) {
  return target.doppler_mps - target.doppler_by_twist * twist;
}

std::vector<std::size_t> fitting(const std::vector<SweepTarget>& targets,
                                 const Eigen::Vector3d& twist) {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (std::abs(residual_mps(targets[i], twist)) <= kMaxResidualMps) {
      result.push_back(i);
    }
  }
  return result;
}

std::optional<Eigen::Vector3d> sampled(const std::vector<SweepTarget>& targets,
                                       std::mt19937& random) {
  std::uniform_int_distribution<std::size_t> any(0, targets.size() - 1);
  Eigen::Matrix3d rows;
  Eigen::Vector3d doppler_mps;
  for (Eigen::Index row = 0; row < 3; ++row) {
    const SweepTarget& target = targets[any(random)];
    rows.row(row) = target.doppler_by_twist;
    doppler_mps(row) = target.doppler_mps;
  }
  const Eigen::FullPivLU<Eigen::Matrix3d> solver(rows);
  return solver.isInvertible() ? std::optional<Eigen::Vector3d>(solver.solve(doppler_mps))
                               : std::nullopt;
}

std::vector<std::size_t> largest_agreement(const std::vector<SweepTarget>& targets) {
  std::mt19937 random(1);
  std::vector<std::size_t> best;
  for (int i = 0; i < kSamples; ++i) {
    if (const auto twist = sampled(targets, random)) {
      std::vector<std::size_t> agreeing = fitting(targets, *twist);
      best = agreeing.size() > best.size() ? std::move(agreeing) : best;
    }
  }
  return best;
}

/// Least squares; the residuals give the noise.
void refine(const std::vector<SweepTarget>& targets, KellnerVelocity& velocity) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const std::size_t i : velocity.standing) {
    const Eigen::RowVector3d& row = targets[i].doppler_by_twist;
    information += row.transpose() * row;
    right += row.transpose() * targets[i].doppler_mps;
  }
  velocity.twist = information.ldlt().solve(right);
  double squares = 0.0;
  for (const std::size_t i : velocity.standing) {
    squares += std::pow(residual_mps(targets[i], velocity.twist), 2);
  }
  const auto freedom = static_cast<double>(velocity.standing.size() - 3);
  velocity.covariance = squares / freedom * information.inverse();
}

}  // namespace

std::optional<KellnerVelocity> kellner_velocity(const std::vector<SweepTarget>& targets) {
  if (targets.size() < kLeastTargets) {
    return std::nullopt;
  }
  KellnerVelocity velocity;
  velocity.standing = largest_agreement(targets);
  for (int i = 0; i < kRefinements && velocity.standing.size() >= kLeastTargets; ++i) {
    refine(targets, velocity);
    velocity.standing = fitting(targets, velocity.twist);
  }
  return velocity.standing.size() >= kLeastTargets ? std::optional(velocity) : std::nullopt;
}

}  // namespace cremed
