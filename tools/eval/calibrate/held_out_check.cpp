// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/calibrate/held_out_check.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace cremed {
namespace {

/// How much better values are in each part.
class Gain {
 public:
  void add(double gain) { gains_.push_back(gain); }

  /// Errors within a part are correlated, those of parts are not: more than the standard deviation
  /// of the sum, by the scatter of its terms.
  [[nodiscard]] bool is_significant() const {
    const auto count = static_cast<double>(gains_.size());
    const double sum = std::accumulate(gains_.begin(), gains_.end(), 0.0);
    const double squares =
        std::inner_product(gains_.begin(), gains_.end(), gains_.begin(), 0.0) - sum * sum / count;
    const double std = std::sqrt(std::max(squares, 0.0) * count / std::max(count - 1.0, 1.0));
    return sum > std;
  }

 private:
  std::vector<double> gains_;
};

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
  Gain gain;
  Gain slip_gain;
  std::vector<Gain> gains(changed.size());
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
    gain.add(configured - found);
    if (configured_slip) {
      slip_gain.add(own.misfit(all_found, configured_slip) - found);
    }
    for (std::size_t radar = 0; radar < changed.size(); ++radar) {
      const auto is_own = [radar](std::size_t other) { return other == radar; };
      gains[radar].add(own.misfit(values_of(others, changed, is_own), slip) - found);
    }
  }
  check.is_better = gain.is_significant();
  check.is_slip_better = !configured_slip || slip_gain.is_significant();
  for (std::size_t radar = 0; radar < changed.size(); ++radar) {
    const bool is_changed = std::ranges::count(changed[radar], true) != 0;
    check.is_radar_better.push_back(!is_changed || gains[radar].is_significant());
  }
  return check;
}

}  // namespace cremed
