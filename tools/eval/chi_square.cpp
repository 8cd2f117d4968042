// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/chi_square.hpp"

#include <cmath>
#include <limits>

namespace cremed {
namespace {

/// Probability that a gamma variable of shape `a` is below `x`, by its series; what is left after
/// the loop is below the sum's last digit.
double gamma_probability(double a, double x) {
  double term = 1.0 / a;
  double sum = term;
  for (double n = 1.0; term > 1e-17 * sum; n += 1.0) {
    term *= x / (a + n);
    sum += term;
  }
  return sum * std::exp(a * std::log(x) - x - std::lgamma(a));
}

/// Value that a chi-square variable stays below with this probability, by bisection.
double chi_square_quantile(double degrees_of_freedom, double probability) {
  const double a = 0.5 * degrees_of_freedom;
  double low = 0.0;
  double high = a + 20.0 * std::sqrt(a) + 40.0;
  while (high - low > 1e-12 * high) {
    const double middle = 0.5 * (low + high);
    (gamma_probability(a, middle) < probability ? low : high) = middle;
  }
  return 2.0 * low;
}

}  // namespace

Interval anees_interval(std::size_t count, int degrees_of_freedom, double confidence) {
  if (count == 0) {
    return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  }
  const double total = static_cast<double>(count) * degrees_of_freedom;
  const double outside = 0.5 * (1.0 - confidence);
  return {chi_square_quantile(total, outside) / total,
          chi_square_quantile(total, 1.0 - outside) / total};
}

}  // namespace cremed
