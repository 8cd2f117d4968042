// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "cremed/can_decoders/can_frame.hpp"

namespace cremed {

/// A frame waiting for the bus.
struct FrameRequest {
  static constexpr std::int64_t kNeverUs = std::numeric_limits<std::int64_t>::max();

  std::int64_t ready_us = kNeverUs;  ///< Earliest time.
  std::uint32_t id = 0;
  std::uint8_t length = 0;
};

/// A device on the bus. Its frames keep their order.
class BusSender {
 public:
  virtual ~BusSender() = default;

  [[nodiscard]] virtual FrameRequest request() const = 0;

  /// The requested frame won arbitration and is complete at `stamp_us`.
  virtual CanFrame send(std::int64_t stamp_us) = 0;

 protected:
  BusSender() = default;
  BusSender(const BusSender&) = default;
  BusSender& operator=(const BusSender&) = default;
};

/// Sends state messages at a fixed period.
class PeriodicSender : public BusSender {
 public:
  /// Sends the frames in turn, one at `first_us` and every `period_us` after it, up to `end_us`.
  /// There must be at least one.
  PeriodicSender(std::vector<CanFrame> frames, std::int64_t first_us, std::int64_t period_us,
                 std::int64_t end_us)
      : frames_(std::move(frames)), next_us_(first_us), period_us_(period_us), end_us_(end_us) {}

  [[nodiscard]] FrameRequest request() const override;
  CanFrame send(std::int64_t stamp_us) override;

 private:
  std::vector<CanFrame> frames_;
  std::size_t turn_ = 0;
  std::int64_t next_us_;
  std::int64_t period_us_;
  std::int64_t end_us_;
};

/// Duration of a frame and the gap after it at 500 kbit/s.
std::int64_t frame_time_us(std::uint8_t length);

/// A CAN bus at 500 kbit/s: one frame at a time, the smallest identifier first.
class CanBus {
 public:
  explicit CanBus(std::uint8_t interface) : interface_(interface) {}

  void attach(std::unique_ptr<BusSender> sender) { senders_.push_back(std::move(sender)); }

  /// Stamp of the next frame, FrameRequest::kNeverUs if there is none.
  [[nodiscard]] std::int64_t next_stamp_us() const;

  /// The next frame; there must be one.
  CanFrame transmit();

 private:
  struct Winner {
    std::size_t sender = 0;
    std::int64_t stamp_us = FrameRequest::kNeverUs;
  };

  [[nodiscard]] Winner arbitrate() const;

  std::uint8_t interface_;
  std::int64_t free_us_ = std::numeric_limits<std::int64_t>::min();
  std::vector<std::unique_ptr<BusSender>> senders_;
};

}  // namespace cremed
