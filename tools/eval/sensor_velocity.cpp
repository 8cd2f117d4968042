// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/sensor_velocity.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Dense>

namespace cremed {
namespace {

constexpr std::size_t kFewestTargets = 6;
constexpr int kTrials = 60;
constexpr double kNarrowestRad = 0.1;  // Between two targets that shall tell a velocity.
constexpr double kFastestMps = 100.0;

double std_mps(const Target& target, const DopplerState& state, const DopplerNoise& noise) {
  return std::hypot(noise.doppler_std_factor * target.doppler_std_mps,
                    noise.azimuth_std_factor * doppler_std_by_azimuth_mps(target, state));
}

double residual_mps(const Target& target, const DopplerState& state) {
  return target.doppler_mps - doppler_row(target, state) * state;
}

/// The velocity that two targets fix.
std::optional<DopplerState> velocity_of(const Target& a, const Target& b) {
  const double determinant = std::sin(b.bearing_rad - a.bearing_rad);
  if (std::abs(determinant) < kNarrowestRad) {
    return std::nullopt;
  }
  return DopplerState{(a.sin_bearing * b.doppler_mps - b.sin_bearing * a.doppler_mps) / determinant,
                      (b.cos_bearing * a.doppler_mps - a.cos_bearing * b.doppler_mps) / determinant,
                      0.0, 0.0};
}

double disagreement(std::span<const Target> targets, const DopplerState& state) {
  double sum = 0.0;
  for (const Target& target : targets) {
    sum += std::min(std::abs(residual_mps(target, state)) / std_mps(target, state, {}), kGateSigma);
  }
  return sum;
}

}  // namespace

Eigen::RowVector4d doppler_row(const Target& target, const DopplerState& near) {
  const double turned = near.x() * target.sin_bearing - near.y() * target.cos_bearing;
  return {-target.cos_bearing, -target.sin_bearing, 1.0, -turned * target.bearing_rad};
}

double doppler_std_by_azimuth_mps(const Target& target, const DopplerState& state) {
  return std::abs(state.x() * target.sin_bearing - state.y() * target.cos_bearing) *
         target.bearing_std_rad;
}

std::optional<DopplerState> agreed_velocity(std::span<const Target> targets) {
  if (targets.size() < kFewestTargets) {
    return std::nullopt;
  }
  std::minstd_rand random(1);
  const auto any = [&] { return targets[random() % targets.size()]; };
  std::optional<DopplerState> best;
  double least = kGateSigma * static_cast<double>(targets.size());
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto velocity = velocity_of(any(), any());
    if (!velocity || velocity->norm() > kFastestMps) {
      continue;
    }
    if (const double cost = disagreement(targets, *velocity); cost < least) {
      least = cost;
      best = velocity;
    }
  }
  return best;
}

std::vector<Target> static_targets(std::span<const Target> targets, const DopplerState& expected,
                                   const DopplerNoise& noise, double slack_mps) {
  std::vector<Target> result;
  std::copy_if(targets.begin(), targets.end(), std::back_inserter(result), [&](const Target& t) {
    return std::abs(residual_mps(t, expected)) <
           kGateSigma * std_mps(t, expected, noise) + slack_mps;
  });
  return result;
}

DopplerEquations doppler_equations(std::span<const Target> targets, const DopplerState& near,
                                   const DopplerNoise& noise) {
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (const Target& target : targets) {
    const double std = std_mps(target, near, noise);
    const Eigen::RowVector4d row = doppler_row(target, near) / std;
    information += row.transpose() * row;
    right += row.transpose() * (target.doppler_mps / std);
  }
  // The shared error is an unknown along the offset, with a prior of its own, eliminated.
  const double shared = noise.shared_std_mps * noise.shared_std_mps;
  const Eigen::Vector4d along = information.col(2);
  const double gain = shared / (1.0 + shared * along.z());
  const double sum = right.z();
  information -= gain * along * along.transpose();
  right -= gain * along * sum;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(information);
  const Eigen::Vector4d root = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  DopplerEquations equations;
  for (int i = 0; i < 4; ++i) {
    if (root[i] > 1e-6 * root[3]) {  // Less is rounding: few targets leave directions open.
      equations.root.row(i) = root[i] * eigen.eigenvectors().col(i).transpose();
      equations.measured[i] = eigen.eigenvectors().col(i).dot(right) / root[i];
    }
  }
  return equations;
}

}  // namespace cremed
