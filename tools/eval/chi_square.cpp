// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/chi_square.hpp"

#include <limits>

#include <boost/math/distributions/chi_squared.hpp>

namespace cremed {

Interval anees_interval(std::size_t count, int degrees_of_freedom, double confidence) {
  if (count == 0) {
    return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  }
  const double total = static_cast<double>(count) * degrees_of_freedom;
  const boost::math::chi_squared distribution(total);
  const double outside = 0.5 * (1.0 - confidence);
  return {boost::math::quantile(distribution, outside) / total,
          boost::math::quantile(boost::math::complement(distribution, outside)) / total};
}

}  // namespace cremed
