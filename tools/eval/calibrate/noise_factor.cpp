// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/calibrate/noise_factor.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace cremed {
namespace {

constexpr std::int64_t kBlockUs = 2'000'000;
constexpr std::size_t kMinErrors = 200;
constexpr std::size_t kMinBlockErrors = 20;
constexpr int kSteps = 50;
constexpr double kMinChange = 1e-6;
constexpr double kLeastVariance = 1e-4;
constexpr double kLeastFactor = 0.1;

/// Expectation maximisation; each step increases the likelihood.
double most_likely_factor(const std::vector<ScaledError>& errors) {
  double variance = 1.0;
  double share = 0.9;
  for (int step = 0; step < kSteps; ++step) {
    double members = 0.0;
    double weights = 0.0;
    double excess = 0.0;
    for (const ScaledError& e : errors) {
      const double all = variance + e.other_variance;
      const double density = share * std::exp(-0.5 * e.error * e.error / all) /
                             std::sqrt(2.0 * std::numbers::pi * all);
      const double member = density / (density + (1.0 - share) / (2.0 * kErrorGate));
      members += member;
      weights += member / (all * all);
      excess += member * (e.error * e.error - all) / (all * all);
    }
    const double before = variance;
    variance = std::max(variance + excess / weights, kLeastVariance);
    share = std::min(members / static_cast<double>(errors.size()), 0.999);
    if (std::abs(variance - before) < kMinChange * variance) {
      break;
    }
  }
  return std::sqrt(variance);
}

}  // namespace

StdFactor noise_factor(const std::vector<ScaledError>& errors, double assumed) {
  if (errors.size() < kMinErrors) {
    return {};
  }
  std::map<std::int64_t, std::vector<ScaledError>> blocks;
  for (const ScaledError& error : errors) {
    blocks[error.stamp_us / kBlockUs].push_back(error);
  }
  const double value = most_likely_factor(errors);
  if (value < kLeastFactor) {
    return {};  // Other errors explain the whole scatter.
  }
  double squares = 0.0;
  double weights = 0.0;
  for (const auto& [number, block] : blocks) {
    if (block.size() >= kMinBlockErrors) {
      const auto weight = static_cast<double>(block.size());
      const double difference = most_likely_factor(block) - value;
      squares += weight * weight * difference * difference;
      weights += weight;
    }
  }
  // At least the standard deviation of as many independent errors.
  const double least = value / std::sqrt(2.0 * static_cast<double>(errors.size()));
  const double by_blocks = weights > 0.0 ? std::sqrt(squares) / weights : value;
  return {assumed * value, assumed * std::max(least, by_blocks)};
}

}  // namespace cremed
