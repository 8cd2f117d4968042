// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/source/stamp_merge.hpp"

namespace cremed {

StampMerge::StampMerge(std::size_t lanes, std::size_t capacity)
    : capacity_(capacity), lanes_(lanes), frames_(lanes * capacity) {}

std::size_t StampMerge::place(std::size_t lane, std::size_t offset) const {
  const std::size_t at = lanes_[lane].begin + offset;
  return lane * capacity_ + (at < capacity_ ? at : at - capacity_);
}

void StampMerge::push(std::size_t lane, const ReceivedFrame& frame) {
  if (!has_frames(lane)) {
    lanes_[lane].first_us = frame.received_us;
  }
  frames_[place(lane, lanes_[lane].count++)] = frame;
  ++size_;
}

void StampMerge::set_read_until(std::size_t lane, std::int64_t stamp_us) {
  lanes_[lane].read_until_us = stamp_us;
}

std::optional<std::size_t> StampMerge::oldest() const {
  if (size_ == 0) {
    return std::nullopt;
  }
  std::size_t best = 0;
  for (std::size_t i = 1; i < lanes_.size(); ++i) {
    best = lanes_[i].first_us < lanes_[best].first_us ? i : best;
  }
  return best;
}

std::optional<std::size_t> StampMerge::awaited() const {
  const auto best = oldest();
  if (!best) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    const std::int64_t until_us = lanes_[i].read_until_us;
    if (!has_frames(i) &&
        (until_us < stamp_us(*best) || (until_us == stamp_us(*best) && i < *best))) {
      return i;
    }
  }
  return std::nullopt;
}

ReceivedFrame& StampMerge::front(std::size_t lane) { return frames_[place(lane, 0)]; }

void StampMerge::pop(std::size_t lane) {
  lanes_[lane].begin = place(lane, 1) - lane * capacity_;
  --lanes_[lane].count;
  --size_;
  lanes_[lane].first_us = has_frames(lane) ? front(lane).received_us : kNone;
}

std::size_t StampMerge::clear(std::size_t lane) {
  const std::size_t dropped = lanes_[lane].count;
  size_ -= dropped;
  lanes_[lane].count = 0;
  lanes_[lane].first_us = kNone;
  return dropped;
}

}  // namespace cremed
