// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/source/live_source.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "daemon/configuration/interfaces.hpp"
#include "daemon/configuration/radar_identifiers.hpp"
#include "daemon/process/clocks.hpp"
#include "daemon/source/can_error.hpp"

namespace cremed {
namespace {

/// Period of idle events on a silent bus, for time-outs and the watchdog.
constexpr int kIdleMs = 20;

/// Period of the check for new and removed interfaces.
constexpr std::int64_t kLookPeriodUs = 200'000;

/// More frames than fit in a millisecond: one of 8 bytes takes 111 us at 1 Mbit/s.
constexpr std::size_t kFramesPerMs = 16;
/// Long enough to save most wake-ups; too short for a scan of more than a few targets to begin and
/// end within it.
constexpr std::size_t kLongestRestMs = 4;

/// Bound on the time from a frame's stamp until it can be read: usually about 10 us in the driver
/// unless interrupted. 1 ms is little beside a radar's cycle.
constexpr std::int64_t kMergeMarginUs = 1000;

/// A full receive buffer is about 40 batches; a bus cannot refill it while it is emptied.
constexpr int kMaxDiscardedBatches = 1000;

std::int64_t rest_us(std::size_t expected_frames) {
  return static_cast<std::int64_t>(std::min(expected_frames / kFramesPerMs, kLongestRestMs)) * 1000;
}

}  // namespace

LiveSource::LiveSource(const Configuration& configuration, const volatile std::sig_atomic_t* stop)
    : max_latency_us_(std::llround(configuration.live.max_latency_s * 1e6)),
      stop_(stop),
      merge_(interface_names(configuration).size(), CanSocket::kBatchFrames) {
  for (const std::string& name : interface_names(configuration)) {
    interfaces_.push_back(std::make_unique<BusConnection>(
        name, ids_on(interfaces_.size(), configuration), configuration.live.socket));
  }
  maintain();
  polled_.resize(interfaces_.size() + 1);
  next_to_read_ = interfaces_.size();
  is_late_.resize(interfaces_.size());
}

BusStatus LiveSource::bus(std::uint8_t interface) const {
  BusStatus status = interfaces_[interface]->status();
  status.clock_steps = clock_steps_;
  return status;
}

std::uint8_t LiveSource::attach(std::uint8_t interface, const std::string& name) {
  BusConnection& found = *interfaces_[interface];
  const auto known =
      std::ranges::find_if(interfaces_, [&](const auto& other) { return other->name() == name; });
  next_look_us_ = 0;
  if (known == interfaces_.end()) {
    found.set_name(name);
    return interface;
  }
  (*known)->add_ids(found.ids());
  return static_cast<std::uint8_t>(known - interfaces_.begin());
}

SourceEvent LiveSource::next(CanFrame& frame) {
  while (*stop_ == 0) {
    const bool is_reading = next_to_read_ < interfaces_.size();
    const auto oldest = merge_.oldest();
    if (!is_reading && oldest && !merge_.awaited()) {
      return take(*oldest, frame);
    }
    const SourceEvent event = is_reading ? read_all(frame) : refill(frame);
    if (event != SourceEvent::frame) {
      return event;
    }
  }
  return SourceEvent::end;
}

SourceEvent LiveSource::take(std::size_t interface, CanFrame& frame) {
  ReceivedFrame& received = merge_.front(interface);
  if (const std::uint32_t lost = std::exchange(received.lost_before, 0U); lost != 0) {
    interfaces_[interface]->status().frames_lost += lost;
    counters_.lost_frames += lost;
    frame.interface = static_cast<std::uint8_t>(interface);
    return SourceEvent::dropped;
  }
  const auto event = judge(interface, received, frame);
  merge_.pop(interface);
  return event;
}

/// The event of a received frame. Error frames and stale ones must not keep the caller waiting:
/// they tell the time, as silence does, with its margin.
SourceEvent LiveSource::judge(std::size_t interface, const ReceivedFrame& received,
                              CanFrame& frame) {
  BusStatus& status = interfaces_[interface]->status();
  frame.interface = static_cast<std::uint8_t>(interface);
  frame.stamp_us = received.received_us - std::int64_t{kIdleMs} * 1000;
  if (received.frame.error) {
    return note_error_frame(received.frame, status) ? SourceEvent::dropped : SourceEvent::idle;
  }
  if (status.bus == BusState::bus_off) {
    status.bus = BusState::error_active;  // Not every driver reports a restart.
  }
  const bool was_late = is_late_[interface];
  is_late_[interface] = is_late(received.received_us, was_late);
  if (is_late_[interface]) {
    ++status.frames_stale;
    return was_late ? SourceEvent::idle : SourceEvent::dropped;
  }
  ++status.frames;
  ++counters_.frames;
  frame = received.frame;
  frame.interface = static_cast<std::uint8_t>(interface);
  return SourceEvent::frame;
}

/// Once late, half of the limit is caught up: a computer that is too slow would otherwise handle
/// only frames that are stale at the end of their scan.
bool LiveSource::is_late(std::int64_t received_us, bool was_late) const {
  return realtime_us() - received_us > (was_late ? max_latency_us_ / 2 : max_latency_us_);
}

void LiveSource::maintain() {
  const std::int64_t now_us = monotonic_us();
  if (now_us < next_look_us_) {
    return;
  }
  next_look_us_ = now_us + kLookPeriodUs;
  links_.update();
  for (std::size_t i = 0; i < interfaces_.size(); ++i) {
    interfaces_[i]->maintain(links_.link(interfaces_[i]->name()));
  }
}

/// Waits until there can be a frame to hand out. `frame` if there is something to read, else the
/// event.
SourceEvent LiveSource::refill(CanFrame& frame) {
  maintain();
  if (merge_.size() == 0) {
    const SourceEvent event = wait(frame);
    if (event != SourceEvent::frame) {
      return event;
    }
  } else {
    hold_back();
  }
  poll_all(0);
  next_to_read_ = 0;
  return SourceEvent::frame;
}

SourceEvent LiveSource::wait(CanFrame& frame) {
  sleep_us(rest_us(expected_frames_));
  const int ready = poll_all(kIdleMs);
  if (clock_watch_.was_set()) {
    return step_clock();
  }
  // Taken before the wait: a delay of this process afterwards is not silence on the bus.
  frame.stamp_us = polled_us_;
  return ready > 0 ? SourceEvent::frame : SourceEvent::idle;
}

/// Waits until no frame earlier than the oldest can arrive.
void LiveSource::hold_back() const {
  const std::int64_t due_us = merge_.stamp_us(*merge_.oldest()) + kMergeMarginUs - realtime_us();
  const std::size_t queued = std::min(expected_frames_, merge_.size());
  sleep_us(std::max(std::min(due_us, kMergeMarginUs), rest_us(expected_frames_ - queued)));
}

int LiveSource::poll_all(int timeout_ms) {
  for (std::size_t i = 0; i < interfaces_.size(); ++i) {
    polled_[i] = {interfaces_[i]->descriptor(), POLLIN, 0};
  }
  polled_.back() = {clock_watch_.descriptor(), POLLIN, 0};
  polled_us_ = realtime_us();
  return ::poll(polled_.data(), polled_.size(), timeout_ms);
}

/// Reads the empty lanes. `frame` when done, else the event.
SourceEvent LiveSource::read_all(CanFrame& frame) {
  while (next_to_read_ < interfaces_.size()) {
    const std::size_t interface = next_to_read_++;
    if (!merge_.has_frames(interface) && read(interface) != 0) {
      frame.interface = static_cast<std::uint8_t>(interface);
      return SourceEvent::dropped;
    }
  }
  // The clock was set after the wait, possibly before these frames.
  return clock_watch_.was_set() ? step_clock() : SourceEvent::frame;
}

/// errno, or 0.
int LiveSource::read(std::size_t interface) {
  const CanReceiveResult result =
      polled_[interface].revents != 0 ? interfaces_[interface]->receive() : CanReceiveResult{};
  for (const ReceivedFrame& received : result.frames) {
    merge_.push(interface, received);
  }
  if (result.frames.size() < CanSocket::kBatchFrames) {
    merge_.set_read_until(interface, read_until_us());
  }
  return result.error;
}

/// Frames stamped before this time have been read from every socket that was empty at polled_us_. A
/// frame from the future shows a clock step that was not detected: it is not waited for.
std::int64_t LiveSource::read_until_us() const {
  const auto oldest = merge_.oldest();
  const bool is_of_future = oldest && merge_.stamp_us(*oldest) > polled_us_ + kMergeMarginUs;
  return is_of_future ? std::numeric_limits<std::int64_t>::max() : polled_us_ - kMergeMarginUs;
}

SourceEvent LiveSource::step_clock() {
  ++clock_steps_;
  next_to_read_ = interfaces_.size();
  for (std::size_t lane = 0; lane < interfaces_.size(); ++lane) {
    const auto& interface = interfaces_[lane];
    interface->status().frames_discarded += merge_.clear(lane);
    for (int i = 0; i < kMaxDiscardedBatches && interface->descriptor() >= 0; ++i) {
      const CanReceiveResult result = interface->receive();
      interface->status().frames_discarded += result.frames.size();
      if (result.frames.empty()) {
        break;
      }
    }
  }
  return SourceEvent::clock_step;
}

}  // namespace cremed
