// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/can_decoders/ars408_tables.hpp"

#include <array>

namespace cremed {
namespace {

// 0.005 * 2000^(index / 30), rounded as in the manufacturer's table.
constexpr std::array<double, 31> kRms{0.005, 0.006, 0.008, 0.011, 0.014, 0.018, 0.023, 0.029,
                                      0.038, 0.049, 0.063, 0.081, 0.105, 0.135, 0.174, 0.224,
                                      0.288, 0.371, 0.478, 0.616, 0.794, 1.023, 1.317, 1.697,
                                      2.187, 2.817, 3.630, 4.676, 6.025, 7.762, 10.000};

}  // namespace

std::optional<double> ars408_rms(std::uint8_t index) {
  return index < kRms.size() ? std::optional(kRms[index]) : std::nullopt;
}

std::optional<double> ars408_std(std::uint8_t index) {
  // sqrt((1 - q^2) / (-2 log q)) with q = 2000^(-1/30)
  constexpr double kOfBound = 0.88573;
  const std::optional<double> bound = ars408_rms(index);
  return bound ? std::optional(kOfBound * *bound) : std::nullopt;
}

}  // namespace cremed
