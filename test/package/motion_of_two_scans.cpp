// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdio>

#include <cremed/estimator/motion/ego_motion_estimator.hpp>

// A car with a radar above its rear axle drives 0.5 m ahead between two scans of twenty posts.
int main() {
  cremed::EgoMotionEstimator estimator{cremed::EgoMotionOptions{}};
  cremed::EgoMotion motion;
  for (int scan_number = 0; scan_number < 2; ++scan_number) {
    cremed::RadarScan scan;
    scan.stamp_us = 100'000 * scan_number;
    for (int post = 0; post < 20; ++post) {
      const double x_m = 8.0 + 4.0 * post - 0.5 * scan_number;
      const double y_m = post % 2 == 0 ? 6.0 : -5.0;
      const double range_m = std::hypot(x_m, y_m);
      scan.detections[scan.count++] = {.range_m = range_m,
                                       .azimuth_rad = std::atan2(y_m, x_m),
                                       .doppler_mps = -5.0 * x_m / range_m,
                                       .range_std_m = 0.1,
                                       .azimuth_std_rad = 0.01,
                                       .doppler_std_mps = 0.1,
                                       .validity = cremed::Validity::usable};
    }
    motion = estimator.update(scan);
  }
  std::printf("%.3f m ahead, sigma %.3f m\n", motion.motion.x(),
              std::sqrt(motion.covariance(0, 0)));
  return motion.has_estimate() && std::abs(motion.motion.x() - 0.5) < 0.01 ? 0 : 1;
}
