// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/bench/floor.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <vector>

#include <benchmark/benchmark.h>

#include "cremed/estimator/cost/exponentiate.hpp"

namespace cremed {
namespace {

/// Long enough to measure, short enough to be rarely interrupted.
constexpr int kFloorPoints = 200;
constexpr int kRepetitions = 150;

/// The sum of components in a row, a metre apart, with the same covariance.
double evaluate(double x_m, std::vector<double>& terms) {
  constexpr double kXx = 0.2;
  constexpr double kXy = 0.01;
  constexpr double kYy = 0.3;
  constexpr double kInverseDet = 1.0 / (kXx * kYy - kXy * kXy);
  constexpr double kY = 0.5;
  for (std::size_t j = 0; j < terms.size(); ++j) {
    const double ex = x_m - static_cast<double>(j);
    terms[j] = -0.5 * (ex * (kYy * ex - kXy * kY) + kY * (kXx * kY - kXy * ex)) * kInverseDet;
  }
  exponentiate(terms);
  return std::accumulate(terms.begin(), terms.end(), 0.0);
}

}  // namespace

double floor_ns(std::size_t components) {
  std::vector<double> terms(components);
  double least_ns = 0.0;
  for (int k = 0; k < kRepetitions; ++k) {
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < kFloorPoints; ++i) {
      benchmark::DoNotOptimize(evaluate(0.1 * i, terms));
    }
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - begin;
    least_ns = k == 0 ? taken.count() : std::min(least_ns, taken.count());
  }
  return least_ns / (kFloorPoints * static_cast<double>(components));
}

}  // namespace cremed
