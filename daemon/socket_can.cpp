// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/socket_can.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "daemon/can_error.hpp"
#include "daemon/clocks.hpp"
#include "daemon/radar_channel.hpp"
#include "daemon/radar_identifiers.hpp"

namespace cremed {
namespace {

/// How often time passes on a silent bus: scans time out, the service tells that it lives.
constexpr int kIdleMs = 20;

/// More frames than can come in a millisecond: one of 8 bytes takes 111 us at 1 Mbit/s.
constexpr std::size_t kFramesPerMs = 16;
/// Long enough to save most wake-ups; too short for a scan of more than a few targets to begin and
/// end in it, on a bus where none is open.
constexpr std::size_t kLongestRestMs = 4;

/// A full receive buffer is some 40 batches; a bus cannot refill it while it is emptied.
constexpr int kMaxDiscardedBatches = 1000;

}  // namespace

SocketCan::SocketCan(const Configuration& configuration, const volatile std::sig_atomic_t* stop)
    : max_latency_us_(std::llround(configuration.live.max_latency_s * 1e6)), stop_(stop) {
  for (const std::string& name : interface_names(configuration)) {
    interfaces_.push_back(std::make_unique<CanInterface>(name, ids_on(name, configuration.radars),
                                                         configuration.live.socket));
    interfaces_.back()->maintain(monotonic_us());
  }
  polled_.resize(interfaces_.size() + 1);
  next_readable_ = interfaces_.size();
}

BusStatus SocketCan::bus(std::uint8_t interface) const {
  BusStatus status = interfaces_[interface]->status();
  status.clock_steps = clock_steps_;
  return status;
}

int SocketCan::send(std::uint8_t interface, const CanFrame& frame) {
  return interfaces_[interface]->send(frame);
}

SourceEvent SocketCan::next(CanFrame& frame) {
  SourceEvent event = SourceEvent::frame;
  while (*stop_ == 0) {
    const bool has_read = !batch_.frames.empty();
    while (!batch_.frames.empty()) {
      if (take(frame, event)) {
        return event;
      }
    }
    if (has_read) {
      return SourceEvent::other;  // However many error frames come, the caller's loop turns.
    }
    event = refill(frame);
    if (event != SourceEvent::frame) {
      return event;
    }
  }
  return SourceEvent::end;
}

/// Goes one step through the batch; true if that is an event.
bool SocketCan::take(CanFrame& frame, SourceEvent& event) {
  const ReceivedFrame& received = batch_.frames.front();
  if (received.lost_before != 0 && !batch_.loss_is_told) {
    batch_.loss_is_told = true;
    interfaces_[batch_.interface]->status().frames_lost += received.lost_before;
    counters_.lost_frames += received.lost_before;
    return report_loss(frame, event);
  }
  batch_.loss_is_told = false;
  batch_.frames = batch_.frames.subspan(1);
  return take(received, frame, event);
}

bool SocketCan::take(const ReceivedFrame& received, CanFrame& frame, SourceEvent& event) {
  BusStatus& status = interfaces_[batch_.interface]->status();
  if (received.frame.error) {
    return note_error_frame(received.frame, status) && report_loss(frame, event);
  }
  if (status.bus == BusState::bus_off) {
    status.bus = BusState::error_active;  // Not every driver tells that it restarted.
  }
  if (batch_.read_us - received.frame.stamp_us > max_latency_us_) {
    ++status.frames_stale;
    if (batch_.stale_is_told) {
      return false;
    }
    batch_.stale_is_told = true;
    return report_loss(frame, event);
  }
  ++status.frames;
  ++counters_.frames;
  frame = received.frame;
  frame.interface = static_cast<std::uint8_t>(batch_.interface);
  event = SourceEvent::frame;
  return true;
}

bool SocketCan::report_loss(CanFrame& frame, SourceEvent& event) {
  frame.interface = static_cast<std::uint8_t>(batch_.interface);
  event = SourceEvent::dropped;
  return true;
}

/// `frame` if there may be a new batch, else what happened instead.
SourceEvent SocketCan::refill(CanFrame& frame) {
  const std::int64_t now_us = monotonic_us();
  for (const auto& interface : interfaces_) {
    interface->maintain(now_us);
  }
  for (; next_readable_ < interfaces_.size(); ++next_readable_) {
    if (polled_[next_readable_].revents != 0) {
      return receive(next_readable_++, frame);
    }
  }
  return wait(frame);
}

SourceEvent SocketCan::receive(std::size_t interface, CanFrame& frame) {
  const CanReceiveResult result = interfaces_[interface]->receive();
  if (clock_watch_.was_set()) {  // After the wait, maybe before these frames.
    interfaces_[interface]->status().frames_discarded += result.frames.size();
    return step_clock();
  }
  batch_ = {interface, result.frames, realtime_us(), false, false};
  if (result.status == CanReceiveStatus::frames || result.status == CanReceiveStatus::empty) {
    return SourceEvent::frame;
  }
  frame.interface = static_cast<std::uint8_t>(interface);
  return SourceEvent::dropped;
}

/// Ends before the last of the expected frames can have come.
void SocketCan::rest() const {
  const std::size_t rest_ms = std::min(expected_frames_ / kFramesPerMs, kLongestRestMs);
  if (rest_ms > 0) {
    const timespec duration{0, static_cast<long>(rest_ms) * 1'000'000};
    ::nanosleep(&duration, nullptr);
  }
}

SourceEvent SocketCan::wait(CanFrame& frame) {
  rest();
  for (std::size_t i = 0; i < interfaces_.size(); ++i) {
    polled_[i] = {interfaces_[i]->descriptor(), POLLIN, 0};
  }
  polled_.back() = {clock_watch_.descriptor(), POLLIN, 0};
  // Before the wait: whoever is held up after it must not take time for passed in silence.
  frame.stamp_us = realtime_us();
  const int ready = ::poll(polled_.data(), polled_.size(), kIdleMs);
  next_readable_ = ready > 0 ? 0 : interfaces_.size();
  if (ready > 0 && polled_.back().revents != 0 && clock_watch_.was_set()) {
    return step_clock();
  }
  return ready > 0 ? SourceEvent::frame : SourceEvent::idle;
}

SourceEvent SocketCan::step_clock() {
  ++clock_steps_;
  next_readable_ = interfaces_.size();
  for (const auto& interface : interfaces_) {
    for (int i = 0; i < kMaxDiscardedBatches && interface->descriptor() >= 0; ++i) {
      const CanReceiveResult result = interface->receive();
      interface->status().frames_discarded += result.frames.size();
      if (result.status != CanReceiveStatus::frames) {
        break;
      }
    }
  }
  return SourceEvent::clock_step;
}

}  // namespace cremed
