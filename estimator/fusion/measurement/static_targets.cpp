// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/measurement/static_targets.hpp"

#include <cmath>

#include "cremed/estimator/fusion/state/state_layout.hpp"

namespace cremed {

using namespace state_layout;

void select_static(const OdometryState& state, std::size_t radar, double age_s,
                   const TargetSet& targets, TargetSet& result) {
  const GaussianState& x = state.gaussian;
  const Pose2& mount = state.mount(radar);
  const double v = x.mean(kSpeed) - age_s * x.mean(kAcceleration);
  const double w = x.mean(kYawRate) - age_s * x.mean(kYawAcceleration);
  const double forward_mps = v - w * mount.y_m;
  const double slip = x.mean(kSlip) - x.mean(kSlipPerAcceleration) * v * w;
  const double across_mps =
      slip * v + w * mount.x_m - x.mean(state.error(radar, kMountYaw)) * forward_mps;
  result.clear();
  for (const Target& target : targets) {
    const double expected_mps = expected_doppler_mps(target, forward_mps, across_mps);
    if (std::abs(target.doppler_mps - expected_mps) <= state.options().static_doppler_mps) {
      result.add(target);
    }
  }
}

}  // namespace cremed
