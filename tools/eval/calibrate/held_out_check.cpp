// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/calibrate/held_out_check.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace cremed {
namespace {

/// Whether values are better, by how much they are in each part: errors within a part are
/// correlated, those of parts are not. More than the standard deviation of the sum, by the scatter
/// of its terms.
bool is_significant(const std::vector<double>& gains) {
  const auto count = static_cast<double>(gains.size());
  const double sum = std::accumulate(gains.begin(), gains.end(), 0.0);
  const double squares =
      std::inner_product(gains.begin(), gains.end(), gains.begin(), 0.0) - sum * sum / count;
  const double std = std::sqrt(std::max(squares, 0.0) * count / std::max(count - 1.0, 1.0));
  return sum > std;
}

/// The fitted values; those that are to be changed as configured where `is_configured` says so.
std::vector<CalibrationVector> values_of(const CalibrationFit& fit,
                                         const std::vector<ChangedStates>& changed,
                                         const std::function<bool(std::size_t)>& is_configured) {
  std::vector<CalibrationVector> values;
  for (std::size_t radar = 0; radar < fit.radars().size(); ++radar) {
    const FittedRadar& fitted = fit.radars()[radar];
    CalibrationVector value = fitted.value;
    for (std::size_t state = 0; state < kCalibrationStates; ++state) {
      if (changed[radar][state] && is_configured(radar)) {
        value[state] = fitted.prior[state];
      }
    }
    values.push_back(value);
  }
  return values;
}

}  // namespace

HeldOutCheck check_held_out(const CalibrationFit& fit, const std::vector<ChangedStates>& changed,
                            const std::optional<double>& configured_slip) {
  HeldOutCheck check;
  std::vector<double> gains;
  std::vector<double> slip_gains;
  std::vector<std::vector<double>> radar_gains(changed.size());
  for (std::size_t part = 0; part < kHeldOutParts; ++part) {
    CalibrationFit others = fit.part(part, kHeldOutParts, false);
    others.minimise();
    const CalibrationFit own = fit.part(part, kHeldOutParts, true);
    const auto slip = configured_slip ? std::optional(others.vehicle().value[kSlip]) : std::nullopt;
    const auto all_configured = values_of(others, changed, [](std::size_t) { return true; });
    const auto all_found = values_of(others, changed, [](std::size_t) { return false; });
    const double configured = own.misfit(all_configured, configured_slip);
    const double found = own.misfit(all_found, slip);
    check.configured += configured;
    check.found += found;
    gains.push_back(configured - found);
    if (configured_slip) {
      slip_gains.push_back(own.misfit(all_found, configured_slip) - found);
    }
    for (std::size_t radar = 0; radar < changed.size(); ++radar) {
      const auto is_own = [radar](std::size_t other) { return other == radar; };
      radar_gains[radar].push_back(own.misfit(values_of(others, changed, is_own), slip) - found);
    }
  }
  check.is_better = is_significant(gains);
  check.is_slip_better = !configured_slip || is_significant(slip_gains);
  for (std::size_t radar = 0; radar < changed.size(); ++radar) {
    const bool is_changed = std::ranges::count(changed[radar], true) != 0;
    check.is_radar_better.push_back(!is_changed || is_significant(radar_gains[radar]));
  }
  return check;
}

}  // namespace cremed
