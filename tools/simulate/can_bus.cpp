// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulate/can_bus.hpp"

#include <algorithm>

namespace cremed {

FrameRequest PeriodicSender::request() const {
  if (next_us_ > end_us_) return {};
  return {next_us_, frames_[turn_].id, frames_[turn_].length};
}

CanFrame PeriodicSender::send(std::int64_t /*stamp_us*/) {
  next_us_ += period_us_;
  const CanFrame frame = frames_[turn_];
  turn_ = (turn_ + 1) % frames_.size();
  return frame;
}

std::int64_t frame_time_us(std::uint8_t length) {
  // 47 bits of overhead, one stuff bit in eight as on real buses, 2 us a bit.
  const std::int64_t bits = 47 + 8 * std::int64_t{length};
  return bits * 9 / 4;
}

CanBus::Winner CanBus::arbitrate() const {
  std::int64_t start_us = FrameRequest::kNeverUs;
  for (const auto& sender : senders_) start_us = std::min(start_us, sender->request().ready_us);
  if (start_us == FrameRequest::kNeverUs) return {};
  start_us = std::max(start_us, free_us_);
  Winner winner;
  FrameRequest best;
  for (std::size_t i = 0; i < senders_.size(); ++i) {
    const FrameRequest request = senders_[i]->request();
    if (request.ready_us > start_us) continue;
    if (winner.stamp_us != FrameRequest::kNeverUs && request.id >= best.id) continue;
    best = request;
    winner = {i, start_us + frame_time_us(request.length)};
  }
  return winner;
}

std::int64_t CanBus::next_stamp_us() const { return arbitrate().stamp_us; }

CanFrame CanBus::transmit() {
  const Winner winner = arbitrate();
  CanFrame frame = senders_[winner.sender]->send(winner.stamp_us);
  frame.stamp_us = winner.stamp_us;
  frame.interface = interface_;
  free_us_ = winner.stamp_us;
  return frame;
}

}  // namespace cremed
