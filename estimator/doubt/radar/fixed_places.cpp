// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/radar/fixed_places.hpp"

#include <algorithm>
#include <cmath>

namespace cremed {
namespace {

/// Four standard deviations of an ARS408's Doppler.
constexpr double kMaxResidualMps = 0.5;

}  // namespace

void take_fixed_places(const TargetSet& targets, const Eigen::Vector2d& velocity_mps,
                       double spacing_m, TargetSet& result) {
  result.clear();
  for (const Target& target : targets) {
    const double residual_mps =
        target.doppler_mps - expected_doppler_mps(target, velocity_mps.x(), velocity_mps.y());
    const auto is_near = [&](const Target& other) {
      return std::abs(other.x_m - target.x_m) < spacing_m &&
             std::abs(other.y_m - target.y_m) < spacing_m;
    };
    if (std::abs(residual_mps) <= kMaxResidualMps &&
        std::none_of(result.begin(), result.end(), is_near)) {
      result.add(target);
    }
  }
}

}  // namespace cremed
