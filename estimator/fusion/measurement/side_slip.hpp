// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "cremed/estimator/fusion/state/gaussian_state.hpp"
#include "cremed/estimator/fusion/state/linear_measurement.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"

namespace cremed {

/// Whether the vehicle skids: a radar behind the rear axle and another one see the same slip that
/// the state does not expect. An unexpected turn would move a radar ahead of the axle to one side,
/// and one behind it, which is near the axle, a little to the other. An error of one radar is seen
/// by that radar only.
class SideSlip {
 public:
  /// `state` must outlive this object.
  explicit SideSlip(const OdometryState& state) : state_(state), seen_(state.radars()) {}

  void clear() { std::fill(seen_.begin(), seen_.end(), Seen()); }
  /// Takes a scan's measurement by Doppler, and its innovation. Returns the size (rad) of the slip
  /// that the state does not expect, if the vehicle skids.
  std::optional<double> add(std::size_t radar, std::int64_t stamp_us,
                            const LinearMeasurement& measurement, const Innovation& innovation);

 private:
  /// A scan that contradicts the expected slip, else zero.
  struct Seen {
    std::int64_t stamp_us = 0;
    double slip_rad = 0.0;
  };

  const OdometryState& state_;
  std::vector<Seen> seen_;  // By radar.
};

}  // namespace cremed
