// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace cremed {

/// The readings of a signal until a scan needs them, as means over a period: readings at 100 Hz
/// share their errors, and a mean of them loses nothing over that time.
class SignalTrack {
 public:
  struct Value {
    std::int64_t utime_us = 0;  ///< Of the measurement.
    double value = 0.0;
  };

  SignalTrack(double period_s, double delay_s);

  /// A reading that is older than the last discards all of them: the clock was set.
  void add(std::int64_t stamp_us, double value);
  void clear();

  /// The earliest mean, if there is one.
  [[nodiscard]] std::optional<Value> front() const;
  void pop();

 private:
  /// At 20 Hz this is longer than the filter goes on without scans (max_gap_s). If it is full, the
  /// earliest mean is dropped.
  static constexpr std::size_t kCapacity = 64;

  void push(const Value& value);

  std::int64_t period_us_;
  std::int64_t delay_us_;
  std::array<Value, kCapacity> values_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  // Of the readings that have no mean yet:
  std::int64_t begin_us_ = 0;
  std::int64_t last_us_ = 0;
  std::int64_t sum_us_ = 0;  // Of the times since begin_us_.
  double sum_ = 0.0;
  int readings_ = 0;
};

}  // namespace cremed
