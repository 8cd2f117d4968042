// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdio>

#include <cremed/estimator/registration/registration.hpp>

/// A post as seen by a radar at the vehicle's origin.
cremed::Detection see(double x_m, double y_m, double yaw_rad, double speed_mps) {
  cremed::Detection detection;
  detection.range_m = std::hypot(x_m, y_m);
  detection.azimuth_rad = std::atan2(y_m, x_m) - yaw_rad;
  detection.doppler_mps = -speed_mps * std::cos(detection.azimuth_rad);
  detection.range_std_m = 0.1;
  detection.azimuth_std_rad = 0.01;
  detection.doppler_std_mps = 0.1;
  return detection;
}

// Registers two scans of a car that drives 0.5 m ahead and turns by 0.02 rad.
int main() {
  cremed::TargetSet previous;
  cremed::TargetSet current;
  for (int i = 0; i < 20; ++i) {
    const double x_m = 8.0 + 4.0 * i;
    const double y_m = i % 2 == 0 ? 6.0 : -5.0;
    previous.add(see(x_m, y_m, 0.0, 5.0), cremed::Pose2{});
    current.add(see(x_m - 0.5, y_m, 0.02, 5.0), cremed::Pose2{});
  }
  cremed::Registration registration(cremed::RegistrationOptions{}, cremed::Pose2{});
  registration.set_previous(previous);
  const cremed::RegistrationResult result = registration.solve(current, 0.1);
  std::printf("x %.3f m, yaw %.4f rad\n", result.motion.x(), result.motion.z());
  return result.status == cremed::RegistrationStatus::converged &&
                 (result.motion - Eigen::Vector3d(0.5, 0.0, 0.02)).norm() < 0.01
             ? 0
             : 1;
}
