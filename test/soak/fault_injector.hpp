// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>

#include "daemon/source/frame_source.hpp"
#include "test/soak/fault_kind.hpp"
#include "tools/simulate/random.hpp"
#include "tools/simulate/simulation.hpp"

namespace cremed::soak {

inline constexpr std::size_t kBuses = 2;

/// The frames of simulated drives as delivered by a live bus with many faults.
class FaultInjector final : public FrameSource {
 public:
  explicit FaultInjector(std::uint64_t seed);

  /// Sets the next drive; it must live until `next` returns `end`.
  void begin(Simulation& drive);

  /// `end`: the drive is over and the buses have been silent for a while.
  SourceEvent next(CanFrame& frame) override;

  /// Time of the drive's own clock, which is never set, and the offset of the daemon's.
  [[nodiscard]] std::int64_t true_us(std::int64_t stamp_us) const { return stamp_us - offset_us_; }
  [[nodiscard]] std::int64_t now_us() const { return now_us_; }

  /// The faults on the bus since then.
  [[nodiscard]] FaultSet faults_since(std::size_t bus, std::int64_t true_us) const;
  [[nodiscard]] std::uint64_t count(FaultKind kind) const {
    return counts_[static_cast<std::size_t>(kind)];
  }

 private:
  struct Event {
    SourceEvent kind = SourceEvent::frame;
    CanFrame frame;  ///< With the drive's stamp.
  };
  struct LateFrame {
    CanFrame frame;
    int overtaken_by = 0;
    bool keeps_stamp = false;
  };
  struct Bus {
    std::int64_t last_us = 0;
    std::int64_t silent_until_us = 0;
    int frames_to_lose = 0;
    std::optional<LateFrame> late;
    std::array<std::int64_t, kFaults.size()> last_fault_us{};
  };

  void refill();
  void end_drive();
  void pass_time(std::int64_t until_us);
  void deliver(const CanFrame& original);
  void disturb_clock(double elapsed_s);
  bool lose(Bus& bus, std::uint8_t interface, double elapsed_s);
  void corrupt(Bus& bus, CanFrame& frame, double elapsed_s);
  bool hold_back(Bus& bus, const CanFrame& frame, double elapsed_s);
  void release_late(Bus& bus, std::int64_t stamp_us);
  bool happens(FaultKind kind, Bus& bus, double elapsed_s);
  double severity(FaultKind kind);
  int whole_severity(FaultKind kind);
  void push(SourceEvent kind, const CanFrame& frame) { events_.push_back({kind, frame}); }

  Random random_;
  Simulation* drive_ = nullptr;
  std::deque<Event> events_;
  std::array<Bus, kBuses> buses_{};
  std::array<std::uint64_t, kFaults.size()> counts_{};
  std::int64_t offset_us_ = 0;
  std::int64_t next_offset_us_ = 0;  ///< Applied after the clock step has been handled.
  std::int64_t now_us_ = 0;
  bool is_over_ = true;
};

}  // namespace cremed::soak
