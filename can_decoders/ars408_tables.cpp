// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/can_decoders/ars408_tables.hpp"

#include <array>
#include <cstddef>
#include <numbers>

namespace cremed {
namespace {

// 0.005 * 2000^(index / 30), rounded as in the manufacturer's table.
constexpr std::array<double, 31> kRms{0.005, 0.006, 0.008, 0.011, 0.014, 0.018, 0.023, 0.029,
                                      0.038, 0.049, 0.063, 0.081, 0.105, 0.135, 0.174, 0.224,
                                      0.288, 0.371, 0.478, 0.616, 0.794, 1.023, 1.317, 1.697,
                                      2.187, 2.817, 3.630, 4.676, 6.025, 7.762, 10.000};

// 0.005 * 36000^(index / 30), degrees.
constexpr std::array<double, 31> kOrientationRmsDeg{
    0.005,  0.007,  0.010,  0.014,  0.020,  0.029,  0.041,  0.058,   0.082,  0.116, 0.165,
    0.234,  0.332,  0.471,  0.669,  0.949,  1.346,  1.909,  2.709,   3.843,  5.451, 7.734,
    10.971, 15.565, 22.081, 31.325, 44.439, 63.044, 89.437, 126.881, 180.000};

constexpr std::array<double, 7> kProbability{0.25, 0.5, 0.75, 0.9, 0.99, 0.999, 1.0};

template <std::size_t size>
std::optional<double> look_up(const std::array<double, size>& table, std::size_t index) {
  return index < size ? std::optional(table[index]) : std::nullopt;
}

}  // namespace

std::optional<double> ars408_rms(std::uint8_t index) { return look_up(kRms, index); }

std::optional<double> ars408_std(std::uint8_t index) {
  // sqrt((1 - q^2) / (-2 log q)) with q = 2000^(-1/30)
  constexpr double kOfBound = 0.88573;
  const std::optional<double> bound = ars408_rms(index);
  return bound ? std::optional(kOfBound * *bound) : std::nullopt;
}

std::optional<double> ars408_orientation_rms_rad(std::uint8_t index) {
  const std::optional<double> deg = look_up(kOrientationRmsDeg, index);
  return deg ? std::optional(*deg * std::numbers::pi / 180.0) : std::nullopt;
}

std::optional<double> ars408_probability(std::uint8_t code) {
  return code > 0 ? look_up(kProbability, code - 1U) : std::nullopt;
}

}  // namespace cremed
