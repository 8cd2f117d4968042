// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulate/slow_error.hpp"

#include <cmath>
#include <numbers>

namespace cremed {
namespace {

constexpr double kLowestHz = 0.3;
constexpr double kHighestHz = 2.0;

}  // namespace

SlowError::SlowError(double standard_deviation, Random random) {
  const double amplitude = standard_deviation * std::sqrt(2.0 / static_cast<double>(sines_.size()));
  for (Sine& sine : sines_) {
    const double hz = random.uniform(kLowestHz, kHighestHz);
    sine = {amplitude, 2.0 * std::numbers::pi * hz, random.uniform(0.0, 2.0 * std::numbers::pi)};
  }
}

double SlowError::at(double time_s) const {
  double sum = 0.0;
  for (const Sine& sine : sines_) {
    sum += sine.amplitude * std::sin(sine.radps * time_s + sine.phase_rad);
  }
  return sum;
}

}  // namespace cremed
