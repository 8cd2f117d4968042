// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/standing_value.hpp"

#include <algorithm>

namespace cremed {

void StandingValue::add(std::int64_t stamp_us, double value) {
  // Values are multiples of a step, so that equal ones are equal bit by bit.
  if (!has_value_ || value != value_ || stamp_us < last_us_) {
    has_value_ = true;
    value_ = value;
    since_us_ = stamp_us;
    has_range_ = false;
  }
  last_us_ = stamp_us;
}

void StandingValue::expect(double value, double tolerance) {
  const double most = value + tolerance;
  const double least = value - tolerance;
  least_upper_ = has_range_ ? std::min(least_upper_, most) : most;
  greatest_lower_ = has_range_ ? std::max(greatest_lower_, least) : least;
  has_range_ = true;
}

}  // namespace cremed
