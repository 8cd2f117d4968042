// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/measurement/signal_track.hpp"

#include <algorithm>
#include <cmath>

namespace cremed {

SignalTrack::SignalTrack(double period_s, double delay_s)
    : period_us_(std::llround(period_s * 1e6)), delay_us_(std::llround(delay_s * 1e6)) {}

void SignalTrack::clear() {
  count_ = 0;
  readings_ = 0;
}

void SignalTrack::add(std::int64_t stamp_us, double value) {
  if (readings_ > 0 && stamp_us < last_us_) {
    clear();
  }
  if (readings_ > 0 && stamp_us - begin_us_ >= period_us_) {
    push({begin_us_ + sum_us_ / readings_ - delay_us_, sum_ / readings_});
    readings_ = 0;
  }
  if (readings_ == 0) {
    begin_us_ = stamp_us;
    sum_us_ = 0;
    sum_ = 0.0;
  }
  last_us_ = stamp_us;
  sum_us_ += stamp_us - begin_us_;
  sum_ += value;
  ++readings_;
}

void SignalTrack::push(const Value& value) {
  if (count_ == kCapacity) {
    pop();
  }
  values_[(first_ + count_) % kCapacity] = value;
  ++count_;
}

std::optional<SignalTrack::Value> SignalTrack::front() const {
  return count_ > 0 ? std::optional(values_[first_]) : std::nullopt;
}

void SignalTrack::pop() {
  first_ = (first_ + 1) % kCapacity;
  --count_;
}

}  // namespace cremed
