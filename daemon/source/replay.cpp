// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/source/replay.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "cremed/estimator/scan/stamps.hpp"
#include "daemon/process/clocks.hpp"
#include "daemon/source/stamp_order.hpp"

namespace cremed {
namespace {

/// More than fit on a full bus at 1 Mbit/s in kLongestDisorderUs, 111 us per frame of 8 bytes.
constexpr std::size_t kLaneFrames = 8192;

/// Limit for messages: a corrupt log may name any number.
constexpr std::size_t kMaxOtherInterfaces = 32;

/// A longer step of the log's clock means that it was set or the log paused.
constexpr double kClockJumpS = 10.0;
constexpr double kLongestWaitUs = 1e15;
/// Short: a signal just before a sleep would not interrupt it.
constexpr std::int64_t kLongestSleepUs = 100'000;

}  // namespace

Replay::Replay(const std::vector<std::string>& paths, std::vector<std::string> interfaces,
               double speed, const volatile std::sig_atomic_t* stop)
    : logs_(paths.begin(), paths.end()),
      interfaces_(std::move(interfaces)),
      has_frames_(interfaces_.size()),
      readings_(logs_.size()),
      has_lost_(logs_.size() * interfaces_.size()),
      merge_(has_lost_.size(), kLaneFrames),
      speed_(speed),
      stop_(stop) {}

SourceEvent Replay::next(CanFrame& frame) {
  while (*stop_ == 0) {
    release_held();
    if (const auto log = log_to_read()) {
      read(*log);
    } else if (const auto lane = merge_.oldest()) {
      return take(*lane, frame);
    } else {
      return SourceEvent::end;
    }
  }
  return SourceEvent::end;
}

/// By interface first: it decides the order of equal stamps.
std::size_t Replay::lane(std::size_t log, std::size_t interface) const {
  return interface * logs_.size() + log;
}

/// A log is read no sooner than needed: the next line of a pipe may not exist yet.
std::optional<std::size_t> Replay::log_to_read() const {
  if (const auto awaited = merge_.awaited()) {
    const std::size_t log = *awaited % logs_.size();
    return any_lane(log, &StampMerge::is_full) ? std::nullopt : std::optional(log);
  }
  if (merge_.size() == 0) {
    for (std::size_t log = 0; log < logs_.size(); ++log) {
      if (!readings_[log].is_at_end) {
        return log;
      }
    }
  }
  return std::nullopt;
}

bool Replay::any_lane(std::size_t log, bool (StampMerge::*is)(std::size_t) const) const {
  for (std::size_t interface = 0; interface < interfaces_.size(); ++interface) {
    if ((merge_.*is)(lane(log, interface))) {
      return true;
    }
  }
  return false;
}

void Replay::read(std::size_t log) {
  CandumpLine line;
  if (!logs_[log].next(line)) {
    readings_[log].is_at_end = true;
    set_read_until(log, std::numeric_limits<std::int64_t>::max());
  } else if (line.status == CandumpStatus::frame) {
    receive(log, line);
  } else if (line.status == CandumpStatus::dropped) {
    note_loss(log, line);
  } else if (line.status == CandumpStatus::malformed) {
    ++counters_.malformed_lines;
  }
}

void Replay::receive(std::size_t log, const CandumpLine& line) {
  const auto interface = static_cast<std::size_t>(
      std::ranges::find(interfaces_, line.interface_name) - interfaces_.begin());
  if (interface == interfaces_.size()) {
    ++counters_.other_interface_frames;
    if (other_interfaces_.size() < kMaxOtherInterfaces) {
      other_interfaces_.insert(std::string(line.interface_name));
    }
    return;
  }
  has_frames_[interface] = true;
  ReceivedFrame received{.frame = line.frame, .received_us = line.frame.stamp_us};
  received.frame.interface = static_cast<std::uint8_t>(interface);
  received.lost_before = has_lost_[lane(log, interface)] ? 1 : 0;
  has_lost_[lane(log, interface)] = false;
  add(log, received);
}

/// What `candump any` lost may be of each interface.
void Replay::note_loss(std::size_t log, const CandumpLine& line) {
  counters_.lost_frames += line.dropped_frames;
  for (std::size_t i = 0; i < interfaces_.size(); ++i) {
    if (line.interface_name == interfaces_[i] || line.interface_name == kAllInterfaces) {
      has_lost_[lane(log, i)] = true;
    }
  }
}

void Replay::add(std::size_t log, const ReceivedFrame& frame) {
  Reading& reading = readings_[log];
  const std::int64_t stamp_us = frame.received_us;
  if (reading.has_begun && stamp_us < reading.newest_us - kLongestDisorderUs) {
    reading.has_begun = false;
    reading.held = frame;
    set_read_until(log, std::numeric_limits<std::int64_t>::max());
    return;
  }
  reading.newest_us = reading.has_begun ? std::max(reading.newest_us, stamp_us) : stamp_us;
  reading.has_begun = true;
  merge_.push(lane(log, frame.frame.interface), frame);
  set_read_until(log, reading.newest_us - kLongestDisorderUs);
}

void Replay::release_held() {
  for (std::size_t log = 0; log < readings_.size(); ++log) {
    if (readings_[log].held && !any_lane(log, &StampMerge::has_frames)) {
      add(log, *std::exchange(readings_[log].held, std::nullopt));
    }
  }
}

void Replay::set_read_until(std::size_t log, std::int64_t stamp_us) {
  for (std::size_t interface = 0; interface < interfaces_.size(); ++interface) {
    merge_.set_read_until(lane(log, interface), stamp_us);
  }
}

SourceEvent Replay::take(std::size_t lane, CanFrame& frame) {
  ReceivedFrame& received = merge_.front(lane);
  frame = received.frame;
  if (std::exchange(received.lost_before, 0U) != 0) {
    return SourceEvent::dropped;
  }
  merge_.pop(lane);
  ++counters_.frames;
  begin_pace(frame.stamp_us);
  wait_until_due(frame.stamp_us);
  return *stop_ == 0 ? SourceEvent::frame : SourceEvent::end;
}

std::optional<double> Replay::share_read() const {
  std::uint64_t all = 0;
  std::uint64_t read = 0;
  for (const auto& log : logs_) {
    if (log.lines().file_bytes() == 0) {
      return std::nullopt;
    }
    all += log.lines().file_bytes();
    read += log.lines().read_bytes();
  }
  return std::min(1.0, static_cast<double>(read) / static_cast<double>(all));
}

/// The pace restarts where the log's clock was set, to skip the jump.
void Replay::begin_pace(std::int64_t stamp_us) {
  const double step_s = seconds_between(last_stamp_us_, stamp_us);
  if (!has_begun_ || step_s < 0.0 || step_s > kClockJumpS) {
    pace_stamp_us_ = stamp_us;
    pace_us_ = monotonic_us();
  }
  traffic_s_ += has_begun_ && step_s >= 0.0 && step_s <= kClockJumpS ? step_s : 0.0;
  has_begun_ = true;
  last_stamp_us_ = stamp_us;
}

void Replay::wait_until_due(std::int64_t stamp_us) const {
  if (speed_ <= 0.0) {
    return;
  }
  const double after_us = static_cast<double>(stamp_us - pace_stamp_us_) / speed_;
  const std::int64_t due_us =
      pace_us_ + static_cast<std::int64_t>(std::min(after_us, kLongestWaitUs));
  for (std::int64_t now_us = monotonic_us(); *stop_ == 0 && now_us < due_us;
       now_us = monotonic_us()) {
    sleep_us(std::min(due_us - now_us, kLongestSleepUs));
  }
}

}  // namespace cremed
