// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/radar/repeated_targets.hpp"

#include <cstddef>

#include "cremed/estimator/scan/squared.hpp"

namespace cremed {
namespace {

constexpr std::size_t kMinRepeatedTargets = 5;
/// Scans in succession, 0.75 s.
constexpr int kMinRepeatsAtRest = 10;
/// Mean square of the Doppler of a moving vehicle: five times an ARS408's noise.
constexpr double kMinDopplerMps = 0.5;

}  // namespace

void RepeatedTargets::add(const TargetSet& targets) {
  Sums sums{targets.size(), Eigen::Vector3d::Zero()};
  double squares = 0.0;
  for (const Target& target : targets) {
    sums.of += Eigen::Vector3d(target.x_m, target.y_m, target.doppler_mps);
    squares += squared(target.doppler_mps);
  }
  const bool is_moving = squares > squared(kMinDopplerMps) * static_cast<double>(targets.size());
  repeats_ = targets.size() >= kMinRepeatedTargets && sums == last_ ? repeats_ + 1 : 0;
  is_repeated_ = repeats_ >= (is_moving ? 1 : kMinRepeatsAtRest);
  last_ = sums;
}

}  // namespace cremed
