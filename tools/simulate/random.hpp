// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

namespace cremed {

/// Random numbers that depend on the seed only, not on compiler or standard library: the standard
/// specifies the engine fully, but not its distributions.
class Random {
 public:
  /// Streams of one seed are independent: a consumer does not affect another's draws.
  Random(std::uint64_t seed, std::uint64_t stream);

  double uniform();  ///< [0, 1)
  double uniform(double low, double high);
  double normal();  ///< Mean 0, variance 1 (Box-Muller).
  bool chance(double probability);
  std::size_t index(std::size_t count);  ///< 0 .. count - 1

 private:
  std::mt19937_64 engine_;
  double spare_normal_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace cremed
