// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/measurement/side_slip.hpp"

#include <algorithm>
#include <cmath>

#include "cremed/estimator/scan/squared.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

/// Of an innovation. Chance exceeds it in one scan of 400 to each side, so of two radars on the
/// same side once in minutes to hours; the slip is then as uncertain as the noise, for a second.
constexpr double kMinSlipSigmas = 2.8;
/// Of scans that are compared: one and a half periods of a slow radar.
constexpr double kMaxApartS = 0.15;
/// A slower vehicle hardly skids, and its slip is the noise of Doppler over a small speed.
constexpr double kMinSpeedMps = 3.0;

}  // namespace

std::optional<double> SideSlip::add(std::size_t radar, std::int64_t stamp_us,
                                    const LinearMeasurement& measurement,
                                    const Innovation& innovation) {
  const double speed_mps = state_.gaussian.mean(state_layout::kSpeed);
  const bool is_expected =
      innovation.nis_of_numbers.y() < squared(kMinSlipSigmas) || std::abs(speed_mps) < kMinSpeedMps;
  const double slip_rad = is_expected ? 0.0 : measurement.residual.y() / speed_mps;
  seen_[radar] = {stamp_us, slip_rad};
  double confirmed_rad = 0.0;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    const bool tells_slip =
        i != radar && std::min(state_.mount(i).x_m, state_.mount(radar).x_m) < 0.0;
    const bool is_recent = std::abs(seconds_between(seen_[i].stamp_us, stamp_us)) <= kMaxApartS;
    if (tells_slip && is_recent && seen_[i].slip_rad * slip_rad > 0.0) {
      confirmed_rad =
          std::max(confirmed_rad, std::min(std::abs(seen_[i].slip_rad), std::abs(slip_rad)));
    }
  }
  return confirmed_rad > 0.0 ? std::optional(confirmed_rad) : std::nullopt;
}

}  // namespace cremed
