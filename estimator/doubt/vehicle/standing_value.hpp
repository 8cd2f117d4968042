// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace cremed {

/// Whether a signal repeats one value: a sender that has frozen, or a vehicle at standstill.
class StandingValue {
 public:
  /// `max_change`: change of the filter's value while the signal repeats, beyond its uncertainty,
  /// that proves the signal frozen.
  explicit StandingValue(double max_change) : max_change_(max_change) {}

  void add(std::int64_t stamp_us, double value);
  /// The filter's own value, now, and its uncertainty.
  void expect(double value, double tolerance);
  void clear() { has_value_ = false; }

  /// The value has not changed for so long that the next ones tell nothing new. Not a fault.
  [[nodiscard]] bool is_standing() const { return is_longer_than(kStandingUs); }
  /// It has not changed while the true value did.
  [[nodiscard]] bool is_frozen() const {
    return is_longer_than(kFrozenUs) && greatest_lower_ - least_upper_ > max_change_;
  }

 private:
  /// Noise of a gyro, and the speed of a driving car, change by a step of the signal within
  /// hundredths of a second. In 0.5 s a yaw rate that froze in a turn moved the state by 5 deg/s.
  static constexpr std::int64_t kStandingUs = 200'000;
  /// A manoeuvre takes seconds; a shorter time could be a step of the filter's own.
  static constexpr std::int64_t kFrozenUs = 2'000'000;

  [[nodiscard]] bool is_longer_than(std::int64_t duration_us) const {
    return has_value_ && last_us_ - since_us_ >= duration_us;
  }

  double max_change_;
  bool has_value_ = false;
  double value_ = 0.0;
  std::int64_t since_us_ = 0;
  std::int64_t last_us_ = 0;
  bool has_range_ = false;
  // Since the signal last changed: the least upper and the greatest lower bound of the filter's
  // value. If the first is below the second, the value has changed by their difference or more.
  double least_upper_ = 0.0;
  double greatest_lower_ = 0.0;
};

}  // namespace cremed
