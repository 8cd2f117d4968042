// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <poll.h>

#include "daemon/configuration/configuration.hpp"
#include "daemon/source/bus_connection.hpp"
#include "daemon/source/clock_watch.hpp"
#include "daemon/source/frame_source.hpp"
#include "daemon/source/link_watch.hpp"
#include "daemon/source/stamp_merge.hpp"

namespace cremed {

/// The CAN interfaces of the configuration, live: frames in the order of the kernel's stamps, for
/// equal stamps in the order of the configuration. A replay of a log gives the same order, and no
/// interface starves another.
///
/// The kernel stamps a frame shortly before it can be read. After a socket was found empty at time
/// T, no frame stamped before T - 1 ms can arrive on it, so a silent interface is never waited for.
/// With several interfaces a frame is held back until it is that old. A frame that the kernel
/// delays longer arrives out of order.
///
/// Stamps are the kernel's (CLOCK_REALTIME). When the clock is set, queued frames are discarded,
/// because their clock is unknown, and clock_step is reported.
///
/// A frame older than live.max_latency_s when it would be handed out is dropped and counted.
///
/// Sends only by BusConnection::send(); allocates only in the constructor.
class LiveSource final : public FrameSource {
 public:
  /// `stop`: next() returns `end` when it is set.
  LiveSource(const Configuration& configuration, const volatile std::sig_atomic_t* stop);

  SourceEvent next(CanFrame& frame) override;
  [[nodiscard]] BusStatus bus(std::uint8_t interface) const override;

  /// At least `frames` more frames are needed to complete a scan: if they take longer than a short
  /// sleep, they are read together after it, instead of with a wake-up for each.
  void expect(std::size_t frames) { expected_frames_ = frames; }

  /// The interface of an "auto" entry (kAutoInterface) was found. Returns the index that its frames
  /// have from now on: the existing entry if another radar uses that interface.
  std::uint8_t attach(std::uint8_t interface, const std::string& name);

  [[nodiscard]] const LinkWatch& links() const { return links_; }

  [[nodiscard]] const std::vector<std::unique_ptr<BusConnection>>& interfaces() const {
    return interfaces_;
  }

 private:
  SourceEvent take(std::size_t interface, CanFrame& frame);
  SourceEvent judge(std::size_t interface, const ReceivedFrame& received, CanFrame& frame);
  [[nodiscard]] bool is_late(std::int64_t received_us, bool was_late) const;
  void maintain();
  SourceEvent refill(CanFrame& frame);
  SourceEvent wait(CanFrame& frame);
  void hold_back() const;
  int poll_all(int timeout_ms);
  SourceEvent read_all(CanFrame& frame);
  int read(std::size_t interface);
  [[nodiscard]] std::int64_t read_until_us() const;
  SourceEvent step_clock();

  std::int64_t max_latency_us_;
  const volatile std::sig_atomic_t* stop_;
  std::vector<std::unique_ptr<BusConnection>> interfaces_;
  LinkWatch links_;
  std::int64_t next_look_us_ = 0;  // Monotonic clock.
  ClockWatch clock_watch_;
  std::uint64_t clock_steps_ = 0;
  std::vector<pollfd> polled_;  // One per interface, then the clock.
  std::int64_t polled_us_ = 0;  // Realtime clock.
  std::size_t next_to_read_;    // Index in polled_; the number of interfaces: none.
  std::size_t expected_frames_ = 0;
  StampMerge merge_;           // A lane per interface.
  std::vector<bool> is_late_;  // By interface: its last frame was stale.
};

}  // namespace cremed
