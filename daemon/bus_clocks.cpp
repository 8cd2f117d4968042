// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bus_clocks.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {

void BusClocks::Offset::note(std::uint32_t other, bool shows_it, int least_buses) {
  pairs = std::clamp(pairs + (shows_it ? 1 : -1), 0, kMinPairs);
  by = pairs == 0 ? 0 : shows_it ? by : by & ~other;
  is_shown = (is_shown && pairs > 0) || (pairs == kMinPairs && std::popcount(by) >= least_buses);
}

void BusClocks::note(const CanFrame& frame) {
  const std::uint32_t bit = set_of(frame.interface);
  Clock& own = clocks_[frame.interface];
  buses_ |= bit;
  // Two other buses must agree. Of only two either may be wrong; if no delay explains the
  // difference, it is the one that is ahead.
  constexpr int kOthers = 2;
  const int ahead_of = std::min(std::popcount(buses_) - 1, kOthers);
  const std::int64_t offset_us = ahead_of == kOthers ? kOffsetUs : kOffsetOfTwoUs;
  for_each(buses_ & ~bit, [&](std::size_t i) {
    if (clocks_[i].last_us - frame.stamp_us > offset_us) {
      clocks_[i].ahead.by |= bit;
      own.behind.by |= set_of(i);
    }
  });
  if (last_interface_ && *last_interface_ != frame.interface) {
    const std::uint32_t before = set_of(*last_interface_);
    Clock& last = clocks_[*last_interface_];
    const std::int64_t back_us = last.last_us - frame.stamp_us;
    own.followed = (own.followed & ~before) | (back_us <= kMaxDifferenceUs ? before : 0U);
    last.ahead.note(bit, back_us > offset_us, ahead_of);
    own.behind.note(before, back_us > offset_us, kOthers);
  }
  own.last_us = frame.stamp_us;
  last_interface_ = frame.interface;
}

bool BusClocks::is_set_back(const CanFrame& frame) {
  Clock& own = clocks_[frame.interface];
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

void ScanClock::forget() {
  last_.reset();
  late_scans_ = 0;
}

ScanTiming ScanClock::judge(const RadarScan& scan) {
  if (modulus_ == 0) {
    return ScanTiming::steady;
  }
  const Scan now{scan.stamp_us, scan.counter};
  const Scan last = last_.value_or(now);
  const std::uint32_t counts = (now.counter + modulus_ - last.counter) % modulus_;
  const double passed_s = seconds_between(last.stamp_us, now.stamp_us);
  if (!(passed_s > 0.0) || (turns_soon() ? passed_s > kMaxPauseS : counts == 0)) {
    last_ = now;
    return ScanTiming::steady;
  }
  const double late_s = lateness_s(passed_s, counts);
  // Without a steady counter (a sensor that starts anew, two sensors with one id) nothing is known.
  const bool is_late =
      (turns_soon() ? std::abs(late_s) : late_s) > kStepS && confirmations_ == kMinConfirmations;
  if (is_late && !is_as_late(late_s)) {
    return ScanTiming::late;  // The next scans are compared with the one before this.
  }
  last_ = now;
  late_scans_ = 0;
  const double periods = std::max(counts, 1U);  // 0: the rest of a scan that a halt divided.
  if (std::abs(late_s) <= kStepS) {
    // Half way: a scan that waited does not make the next one early.
    last_->stamp_us -= std::llround(0.5e6 * late_s);
    period_s_ += late_s / periods / kMinConfirmations;
    confirmations_ = std::min(confirmations_ + 1, kMinConfirmations);
    return ScanTiming::steady;
  }
  step_ = {periods * period_s_, passed_s - periods * period_s_};
  period_s_ = passed_s / periods;
  confirmations_ = 0;
  return is_late ? ScanTiming::set_forward : ScanTiming::steady;
}

std::optional<ForwardStep> ScanClock::step() const {
  return step_.counted_s < kMaxPauseS ? std::optional(step_) : std::nullopt;
}

double ScanClock::lateness_s(double passed_s, std::uint32_t counts) const {
  const double late_s = passed_s - counts * period_s_;
  return turns_soon() && period_s_ > 0.0 ? std::remainder(late_s, modulus_ * period_s_) : late_s;
}

/// Whether the scan is as late as the one before, or one more than kMaxLate in a row are late.
bool ScanClock::is_as_late(double late_s) {
  const bool is_alike = late_scans_ > 0 && std::abs(late_s - late_s_) <= kStepS;
  late_s_ = late_s;
  return is_alike || ++late_scans_ > kMaxLate;
}

}  // namespace cremed
