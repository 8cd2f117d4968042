// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "tools/simulate/random.hpp"

namespace cremed {

/// An error that varies smoothly and randomly with time: a sum of sines of 0.3 to 2 Hz,
/// uncorrelated after some tenths of a second.
class SlowError {
 public:
  SlowError(double standard_deviation, Random random);

  [[nodiscard]] double at(double time_s) const;

 private:
  struct Sine {
    double amplitude;
    double radps;
    double phase_rad;
  };
  std::array<Sine, 12> sines_;
};

/// Share of a driving vehicle's errors at a speed: 0 at standstill, 1 from 1 m/s.
double driving_share(double speed_mps);

}  // namespace cremed
