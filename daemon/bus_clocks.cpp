// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bus_clocks.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {

void BusClocks::note(const CanFrame& frame) {
  if (last_ && last_->interface != frame.interface) {
    const std::uint32_t before = bit_of(last_->interface);
    const bool agree = last_->stamp_us - frame.stamp_us <= kMaxDifferenceUs;
    std::uint32_t& followed = clocks_[frame.interface].followed;
    followed = (followed & ~before) | (agree ? before : 0U);
  }
  last_ = {frame.interface, frame.stamp_us};
}

bool BusClocks::is_set_back(const CanFrame& frame) {
  Clock& own = clocks_[frame.interface];
  for (Clock& other : clocks_) {
    if (&other == &own || !other.latest_us) {
      continue;
    }
    const bool is_behind = frame.stamp_us < *other.latest_us - kAheadUs;
    other.frames_behind = is_behind ? std::min(other.frames_behind + 1, kMinFramesBehind) : 0;
  }
  const bool is_back = own.latest_us && frame.stamp_us < *own.latest_us - kSetBackUs;
  own.frames_back = is_back ? own.frames_back + 1 : 0;
  if (is_back && own.frames_back < kMinFramesBack) {
    return false;
  }
  own.latest_us =
      is_back ? frame.stamp_us : std::max(own.latest_us.value_or(frame.stamp_us), frame.stamp_us);
  own.frames_back = 0;
  return is_back;
}

bool ScanClock::is_set_forward(const RadarScan& scan) {
  const auto last = std::exchange(last_, Scan{scan.stamp_us, scan.counter});
  if (!last || modulus_ < kMinModulus) {
    return false;
  }
  const std::uint32_t counts = (scan.counter + modulus_ - last->counter) % modulus_;
  const double passed_s = seconds_between(last->stamp_us, scan.stamp_us);
  if (counts == 0 || !(passed_s > 0.0)) {
    return false;
  }
  const double excess_s = passed_s - counts * period_s_;
  if (std::abs(excess_s) <= kStepS) {
    confirmations_ = std::min(confirmations_ + 1, kMinConfirmations);
    return false;
  }
  // Without a steady counter (a sensor that starts anew, two sensors with one id) nothing is known.
  const bool is_step = excess_s > kStepS && confirmations_ == kMinConfirmations;
  period_s_ = passed_s / counts;
  confirmations_ = 0;
  return is_step;
}

}  // namespace cremed
