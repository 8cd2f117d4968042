// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Variance of the residuals of Doppler of one radar, beyond its noise: slow traffic among the
/// static targets, before the two can be told apart target by target.
class DopplerExcess {
 public:
  /// After a gap: the traffic may be gone, the radar's noise stays.
  void forget() { mean_m2ps2_ = noise_m2ps2_; }
  /// Takes a scan, its velocity, and the time since the last scan. Returns the excess (m^2/s^2);
  /// 0 of a scan with too few targets.
  double add(const TargetSet& targets, const Eigen::Vector2d& velocity_mps, double dt_s);

 private:
  int scans_ = 0;             // Of the first.
  double mean_m2ps2_ = 0.0;   // Of the squares, over the last scans.
  double noise_m2ps2_ = 0.0;  // The least of it, nearly.
};

}  // namespace cremed
