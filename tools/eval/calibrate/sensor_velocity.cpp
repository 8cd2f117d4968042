// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/calibrate/sensor_velocity.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Dense>

namespace cremed {
namespace {

constexpr std::size_t kMinTargets = 6;
constexpr int kTrials = 60;
constexpr double kNarrowestRad = 0.1;  // Least angle between two targets that determine a velocity.
constexpr double kFastestMps = 100.0;

double std_mps(const Target& target, const DopplerState& state, const DopplerNoise& noise) {
  return std::hypot(noise.doppler_std_factor * target.doppler_std_mps,
                    noise.azimuth_std_factor * doppler_std_by_azimuth_mps(target, state));
}

double residual_mps(const Target& target, const DopplerState& state, double told_yaw_rate_radps) {
  return target.doppler_mps - doppler_row(target, state, told_yaw_rate_radps) * state;
}

/// The velocity determined by two targets.
std::optional<DopplerState> velocity_of(const Target& a, const Target& b) {
  const double determinant = std::sin(b.bearing_rad - a.bearing_rad);
  if (std::abs(determinant) < kNarrowestRad) {
    return std::nullopt;
  }
  return DopplerState((a.sin_bearing * b.doppler_mps - b.sin_bearing * a.doppler_mps) / determinant,
                      (b.cos_bearing * a.doppler_mps - a.cos_bearing * b.doppler_mps) / determinant,
                      0.0, 0.0, 0.0);
}

double disagreement(std::span<const Target> targets, const DopplerState& state) {
  double sum = 0.0;
  for (const Target& target : targets) {
    sum += std::min(std::abs(residual_mps(target, state, 0.0)) / std_mps(target, state, {}),
                    kGateSigma);
  }
  return sum;
}

/// Information and its right-hand side with errors of the first three states, of these standard
/// deviations, as marginalised unknowns.
void add_shared_errors(const Eigen::Vector3d& std, DopplerMatrix& information,
                       DopplerState& right) {
  const Eigen::Matrix<double, kDopplerStates, 3> along =
      information.leftCols<3>() * std.asDiagonal();
  const Eigen::Vector3d sum = std.cwiseProduct(right.head<3>());
  const Eigen::Matrix3d eliminated =
      Eigen::Matrix3d::Identity() + std.asDiagonal() * along.topRows<3>();
  const Eigen::LLT<Eigen::Matrix3d> factors(eliminated);
  right -= along * factors.solve(sum);
  information -= along * factors.solve(along.transpose());
}

}  // namespace

DopplerRow doppler_row(const Target& target, const DopplerState& near, double told_yaw_rate_radps) {
  const double turned = near.x() * target.sin_bearing - near.y() * target.cos_bearing;
  const double range_m = std::hypot(target.x_m, target.y_m);
  return DopplerRow(-target.cos_bearing, -target.sin_bearing, 1.0, turned * target.bearing_rad,
                    told_yaw_rate_radps * told_yaw_rate_radps * range_m);
}

double doppler_std_by_azimuth_mps(const Target& target, const DopplerState& state) {
  return std::abs(state.x() * target.sin_bearing - state.y() * target.cos_bearing) *
         target.bearing_std_rad;
}

std::optional<DopplerState> agreed_velocity(std::span<const Target> targets) {
  if (targets.size() < kMinTargets) {
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

RecordedScan static_part(const RecordedScan& scan, const DopplerState& expected,
                         const DopplerNoise& noise) {
  constexpr double kSlackMps = 0.1;
  RecordedScan result{scan.stamp_us, {}, scan.told_yaw_rate_radps};
  std::ranges::copy_if(scan.targets, std::back_inserter(result.targets), [&](const Target& t) {
    return std::abs(residual_mps(t, expected, scan.told_yaw_rate_radps)) <
           kGateSigma * std_mps(t, expected, noise) + kSlackMps;
  });
  return result;
}

DopplerEquations doppler_equations(const RecordedScan& scan, const DopplerState& near,
                                   const DopplerNoise& noise) {
  DopplerMatrix information = DopplerMatrix::Zero();
  DopplerState right = DopplerState::Zero();
  for (const Target& target : scan.targets) {
    const double std = std_mps(target, near, noise);
    const DopplerRow row = doppler_row(target, near, scan.told_yaw_rate_radps) / std;
    information += row.transpose() * row;
    right += row.transpose() * (target.doppler_mps / std);
  }
  add_shared_errors(
      {noise.shared_velocity_std_mps, noise.shared_velocity_std_mps, noise.shared_offset_std_mps},
      information, right);
  const Eigen::SelfAdjointEigenSolver<DopplerMatrix> eigen(information);
  const DopplerState root = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  DopplerEquations equations;
  for (int i = 0; i < kDopplerStates; ++i) {
    // Smaller eigenvalues are rounding: few targets leave directions undetermined.
    if (root[i] > 1e-6 * root[kDopplerStates - 1]) {
      equations.root.row(i) = root[i] * eigen.eigenvectors().col(i).transpose();
      equations.measured[i] = eigen.eigenvectors().col(i).dot(right) / root[i];
    }
  }
  return equations;
}

}  // namespace cremed
