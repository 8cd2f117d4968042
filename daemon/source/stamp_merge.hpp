// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "daemon/source/received_frame.hpp"

namespace cremed {

/// Merges the frames of several lanes (interfaces, live or of a log) by ReceivedFrame::received_us,
/// equal stamps by lane number. Frames of one lane are never reordered.
///
///     while (const auto lane = merge.oldest()) {
///       if (merge.awaited()) { read on in that lane, or wait; }
///       else { use(merge.front(*lane)); merge.pop(*lane); }
///     }
///
/// Holds at most `capacity` frames per lane; allocates in the constructor only.
class StampMerge {
 public:
  StampMerge(std::size_t lanes, std::size_t capacity);

  /// The lane must not be full.
  void push(std::size_t lane, const ReceivedFrame& frame);
  /// All frames of the lane stamped before `stamp_us` have been pushed.
  void set_read_until(std::size_t lane, std::int64_t stamp_us);

  /// Lane of the earliest frame in the lanes; nothing if there are none.
  [[nodiscard]] std::optional<std::size_t> oldest() const;
  /// An empty lane on which a frame earlier than the oldest may still arrive; nothing if there is
  /// none.
  [[nodiscard]] std::optional<std::size_t> awaited() const;

  /// Stamp of the lane's first frame; the lane must not be empty.
  [[nodiscard]] std::int64_t stamp_us(std::size_t lane) const { return lanes_[lane].first_us; }
  [[nodiscard]] ReceivedFrame& front(std::size_t lane);
  void pop(std::size_t lane);
  /// Drops the frames of a lane; returns their number.
  std::size_t clear(std::size_t lane);

  [[nodiscard]] bool has_frames(std::size_t lane) const { return lanes_[lane].count > 0; }
  [[nodiscard]] bool is_full(std::size_t lane) const { return lanes_[lane].count == capacity_; }
  /// Frames in all lanes.
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  /// After any stamp.
  static constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::max();
  /// Small, so that few lines of the cache hold all: they are compared for every frame.
  struct Lane {
    std::size_t begin = 0;  // In its ring.
    std::size_t count = 0;
    std::int64_t first_us = kNone;  // Stamp of the first frame.
    std::int64_t read_until_us = std::numeric_limits<std::int64_t>::min();
  };
  [[nodiscard]] std::size_t place(std::size_t lane, std::size_t offset) const;

  std::size_t capacity_;
  std::vector<Lane> lanes_;
  std::vector<ReceivedFrame> frames_;  // A ring of `capacity_` frames per lane.
  std::size_t size_ = 0;
};

}  // namespace cremed
