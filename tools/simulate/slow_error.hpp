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

}  // namespace cremed
