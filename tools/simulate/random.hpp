// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

namespace cremed {

/// Random numbers that are the same for a seed with every compiler and standard library: the
/// engine is fully specified by the standard, its distributions are not.
class Random {
 public:
  /// Streams of one seed are independent, so that one consumer's draws never shift another's.
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
