// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/scan/rotation_lead.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace cremed {
namespace {

/// Noise of the velocity across the line of sight: 0.085 m/s RMS around the fit on four drives,
/// from the sensor's grid of 0.25 m/s.
constexpr double kAcrossStdMps = 0.1;
/// Prior of sensor velocity and yaw rate. It covers the motion of road vehicles.
constexpr double kPriorSpeedStdMps = 30.0;
constexpr double kPriorYawRateStdRadps = 1.0;
/// Scale of the Geman-McClure weight, in standard deviations. It suppresses targets that are not
/// static, about 1 % on the drives.
constexpr double kOutlierDeviations = 3.0;
/// The first iteration is plain least squares. The weights no longer change after the third.
constexpr int kIterations = 4;

/// One row: A = (sin phi, -cos phi, -r) (v_x, v_y, w).
struct Row {
  Eigen::Vector3d regressor;
  double across_mps;
};

double weight_of(double residual_mps) {
  const double deviations = residual_mps / (kOutlierDeviations * kAcrossStdMps);
  const double root = 1.0 / (1.0 + deviations * deviations);
  return root * root;
}

}  // namespace

double reported_yaw_rate_radps(const RadarScan& scan) {
  std::array<Row, kMaxDetections> rows;
  std::size_t count = 0;
  const std::size_t size = std::min<std::size_t>(scan.count, scan.detections.size());
  for (std::size_t i = 0; i < size; ++i) {
    const Detection& d = scan.detections[i];
    if (d.validity == Validity::usable) {
      rows[count++] = {{std::sin(d.azimuth_rad), -std::cos(d.azimuth_rad), -d.range_m},
                       d.across_mps};
    }
  }
  const auto prior_information = [](double std) {
    return kAcrossStdMps * kAcrossStdMps / (std * std);
  };
  const Eigen::Vector3d prior(prior_information(kPriorSpeedStdMps),
                              prior_information(kPriorSpeedStdMps),
                              prior_information(kPriorYawRateStdRadps));
  Eigen::Vector3d motion = Eigen::Vector3d::Zero();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::Matrix3d information = prior.asDiagonal();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < count; ++i) {
      const auto& [regressor, across_mps] = rows[i];
      const double weight = iteration == 0 ? 1.0 : weight_of(across_mps - regressor.dot(motion));
      information.noalias() += weight * regressor * regressor.transpose();
      sum += weight * across_mps * regressor;
    }
    motion = information.llt().solve(sum);
  }
  return motion.z();
}

Detection turned(const Detection& detection, double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  Detection result = detection;
  result.azimuth_rad += angle_rad;
  result.doppler_mps = c * detection.doppler_mps + s * detection.across_mps;
  result.across_mps = c * detection.across_mps - s * detection.doppler_mps;
  return result;
}

}  // namespace cremed
