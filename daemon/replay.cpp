// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/replay.hpp"

#include <algorithm>
#include <ctime>
#include <utility>

namespace cremed {
namespace {

constexpr std::int64_t kNsPerS = 1'000'000'000;

/// A longer step of the log's clock is a clock that was set, or a log that was paused.
constexpr double kClockJumpS = 10.0;
constexpr double kLongestWaitNs = 1e18;
constexpr std::int64_t kLongestSleepNs = 200'000'000;

std::int64_t monotonic_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kNsPerS + now.tv_nsec;
}

}  // namespace

Replay::Replay(std::vector<std::unique_ptr<CandumpLog>> logs, double speed,
               const volatile std::sig_atomic_t* stop)
    : logs_(std::move(logs)), pending_(logs_.size()), speed_(speed), stop_(stop) {}

SourceEvent Replay::next(CanFrame& frame) {
  read_pending();
  Pending& pending = pending_[earliest()];
  frame = pending.frame;
  if (pending.event == SourceEvent::frame) {
    begin_pace(frame.stamp_us);
    wait_until_due(frame.stamp_us);
  }
  if (*stop_ != 0) {
    return SourceEvent::end;
  }
  // A log at its end stays so; any other is read on when the next event is asked for, not before:
  // a pipe may not have it yet.
  pending.is_read = pending.event == SourceEvent::end;
  return pending.event;
}

void Replay::read_pending() {
  counters_ = {};
  for (std::size_t i = 0; i < logs_.size(); ++i) {
    if (!pending_[i].is_read) {
      pending_[i].event = logs_[i]->next(pending_[i].frame);
      pending_[i].is_read = true;
    }
    const SourceCounters& counters = logs_[i]->counters();
    counters_.frames += counters.frames;
    counters_.other_interface_frames += counters.other_interface_frames;
    counters_.lost_frames += counters.lost_frames;
    counters_.malformed_lines += counters.malformed_lines;
  }
}

/// The log whose event comes first: a report of lost frames (it has no stamp of its own) before any
/// frame, then frames by stamp; the first log if all are at their end.
std::size_t Replay::earliest() const {
  std::size_t best = 0;
  for (std::size_t i = 0; i < pending_.size(); ++i) {
    if (pending_[i].event == SourceEvent::dropped) {
      return i;
    }
    if (pending_[i].event == SourceEvent::frame &&
        (pending_[best].event == SourceEvent::end ||
         pending_[i].frame.stamp_us < pending_[best].frame.stamp_us)) {
      best = i;
    }
  }
  return best;
}

/// The pace begins anew where the log's clock was set: nobody wants to wait for a jump's length.
void Replay::begin_pace(std::int64_t stamp_us) {
  const double step_s =
      (static_cast<double>(stamp_us) - static_cast<double>(last_stamp_us_)) * 1e-6;
  if (!has_begun_ || step_s < 0.0 || step_s > kClockJumpS) {
    pace_stamp_us_ = stamp_us;
    pace_ns_ = monotonic_ns();
  }
  traffic_s_ += has_begun_ && step_s >= 0.0 && step_s <= kClockJumpS ? step_s : 0.0;
  has_begun_ = true;
  last_stamp_us_ = stamp_us;
}

void Replay::wait_until_due(std::int64_t stamp_us) const {
  if (speed_ <= 0.0) {
    return;
  }
  const double after_ns = static_cast<double>(stamp_us - pace_stamp_us_) * 1e3 / speed_;
  const std::int64_t due_ns =
      pace_ns_ + static_cast<std::int64_t>(std::min(after_ns, kLongestWaitNs));
  for (std::int64_t now_ns = monotonic_ns(); *stop_ == 0 && now_ns < due_ns;
       now_ns = monotonic_ns()) {
    // In short sleeps: a signal just before one would be slept through.
    const std::int64_t until_ns = std::min(due_ns, now_ns + kLongestSleepNs);
    const timespec until{until_ns / kNsPerS, until_ns % kNsPerS};
    ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
  }
}

}  // namespace cremed
