// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <csignal>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <poll.h>

#include "daemon/can_interface.hpp"
#include "daemon/clock_watch.hpp"
#include "daemon/configuration.hpp"
#include "daemon/frame_source.hpp"

namespace cremed {

/// The CAN interfaces of the configuration, live. Interfaces take turns, a batch of frames each, so
/// that a busy one does not starve another. Frames of one interface come in the order in which they
/// were received; those of different interfaces nearly so.
///
/// Stamps are the kernel's (CLOCK_REALTIME). When the clock is set, what waits in the sockets was
/// stamped before or after, nobody knows: it is thrown away, and clock_step is reported.
///
/// Never sends but by send(); after construction allocates nothing.
class SocketCan final : public FrameSource {
 public:
  /// `stop`: next() returns `end` when it is set.
  SocketCan(const Configuration& configuration, const volatile std::sig_atomic_t* stop);

  SourceEvent next(CanFrame& frame) override;
  [[nodiscard]] BusStatus bus(std::uint8_t interface) const override;

  /// Nothing can come of the next so many frames but waiting for more: where they take longer than
  /// a short rest, they are read together after it, instead of one wake-up each.
  void expect(std::size_t frames) { expected_frames_ = frames; }

  /// errno, or 0.
  int send(std::uint8_t interface, const CanFrame& frame);

  [[nodiscard]] const std::vector<std::unique_ptr<CanInterface>>& interfaces() const {
    return interfaces_;
  }

 private:
  /// The frames of one interface that are being handed out.
  struct Batch {
    std::size_t interface = 0;
    std::span<const ReceivedFrame> frames;
    std::int64_t read_us = 0;    // Realtime.
    bool loss_is_told = false;   // of the first frame
    bool stale_is_told = false;  // of the batch
  };
  bool take(CanFrame& frame, SourceEvent& event);
  bool take(const ReceivedFrame& received, CanFrame& frame, SourceEvent& event);
  bool report_loss(CanFrame& frame, SourceEvent& event);
  SourceEvent refill(CanFrame& frame);
  SourceEvent receive(std::size_t interface, CanFrame& frame);
  void rest() const;
  SourceEvent wait(CanFrame& frame);
  SourceEvent step_clock();

  std::int64_t max_latency_us_;
  const volatile std::sig_atomic_t* stop_;
  std::vector<std::unique_ptr<CanInterface>> interfaces_;
  ClockWatch clock_watch_;
  std::uint64_t clock_steps_ = 0;
  std::vector<pollfd> polled_;  // One each interface, then the clock.
  std::size_t next_readable_ = 0;
  std::size_t expected_frames_ = 0;
  Batch batch_;
};

}  // namespace cremed
