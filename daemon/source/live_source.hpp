// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <poll.h>

#include "daemon/configuration/configuration.hpp"
#include "daemon/source/bus_connection.hpp"
#include "daemon/source/clock_watch.hpp"
#include "daemon/source/frame_source.hpp"
#include "daemon/source/link_watch.hpp"
#include "daemon/source/stamp_merge.hpp"

namespace cremed {

/// The CAN interfaces of the configuration, live: their frames in order of the kernel's stamps,
/// where stamps are equal in the order of the configuration. So a replay of what was logged beside
/// it sees the same frames in the same order, and no interface starves another.
///
/// The kernel stamps a frame shortly before it can be read. So once a socket was read empty at a
/// time T, no frame stamped before T - 1 ms can come on it any more, and a silent interface
/// is never waited for. With several interfaces a frame is held back until it is that old. One that
/// the kernel delays for longer still comes late and out of order, but comes.
///
/// Stamps are the kernel's (CLOCK_REALTIME). When the clock is set, what waits was stamped before
/// or after, nobody knows: it is thrown away, and clock_step is reported.
///
/// Never sends but by send(); after construction allocates nothing.
class LiveSource final : public FrameSource {
 public:
  /// `stop`: next() returns `end` when it is set.
  LiveSource(const Configuration& configuration, const volatile std::sig_atomic_t* stop);

  SourceEvent next(CanFrame& frame) override;
  [[nodiscard]] BusStatus bus(std::uint8_t interface) const override;

  /// Nothing can come of the next so many frames but waiting for more: where they take longer than
  /// a short rest, they are read together after it, instead of one wake-up each.
  void expect(std::size_t frames) { expected_frames_ = frames; }

  /// The interface of an entry that had none (kAutoInterface) is known. Returns the entry that has
  /// its frames from now on: where others are on that interface, theirs.
  std::uint8_t attach(std::uint8_t interface, const std::string& name);

  [[nodiscard]] const LinkWatch& links() const { return links_; }

  /// errno, or 0.
  int send(std::uint8_t interface, const CanFrame& frame);

  [[nodiscard]] const std::vector<std::unique_ptr<BusConnection>>& interfaces() const {
    return interfaces_;
  }

 private:
  /// The frames of one interface that were read last.
  struct Batch {
    std::int64_t read_us = 0;    // Realtime.
    bool stale_is_told = false;  // Of these frames.
  };
  std::optional<SourceEvent> take(std::size_t interface, CanFrame& frame);
  std::optional<SourceEvent> judge(std::size_t interface, const ReceivedFrame& received,
                                   CanFrame& frame);
  void maintain();
  SourceEvent refill(CanFrame& frame);
  SourceEvent wait(CanFrame& frame);
  void hold_back() const;
  int poll_all(int timeout_ms);
  SourceEvent read_all(CanFrame& frame);
  CanReceiveStatus read(std::size_t interface);
  [[nodiscard]] std::int64_t read_until_us() const;
  SourceEvent step_clock();

  std::int64_t max_latency_us_;
  const volatile std::sig_atomic_t* stop_;
  std::vector<std::unique_ptr<BusConnection>> interfaces_;
  LinkWatch links_;
  std::int64_t next_look_us_ = 0;  // Monotonic.
  ClockWatch clock_watch_;
  std::uint64_t clock_steps_ = 0;
  std::vector<pollfd> polled_;  // One each interface, then the clock.
  std::int64_t polled_us_ = 0;  // Realtime.
  std::size_t next_to_read_;    // Of those polled; the number of interfaces: none.
  std::size_t expected_frames_ = 0;
  StampMerge merge_;  // A lane an interface.
  std::vector<Batch> batches_;
};

}  // namespace cremed
