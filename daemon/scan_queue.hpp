// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace cremed {

/// The complete scans of all radars, at most one a radar, in the order of their stamps. The first
/// waits for scans that began before it and are still open, but no longer than a scan can last.
///
///     while (const auto scan = queue.pop(now_us, is_awaiting)) { use(*scan); }
///
/// Allocates in the constructor only.
class ScanQueue {
 public:
  /// Bound on the duration of a scan: the cycle of an ARS408.
  static constexpr std::int64_t kLongestWaitUs = 75'000;

  struct Scan {
    std::size_t radar;
    std::int64_t stamp_us;
  };

  explicit ScanQueue(std::size_t radars) : stamps_us_(radars) {}

  /// The queue must not hold a scan of this radar.
  void push(Scan scan) { stamps_us_[scan.radar] = scan.stamp_us; }
  [[nodiscard]] bool holds(std::size_t radar) const { return stamps_us_[radar].has_value(); }
  void clear() { stamps_us_.assign(stamps_us_.size(), std::nullopt); }

  /// Takes the earliest scan out; nothing if there is none.
  std::optional<Scan> pop() {
    const auto scan = first();
    if (scan) {
      stamps_us_[scan->radar].reset();
    }
    return scan;
  }
  /// Takes the earliest scan out if at `now_us` it has waited long enough or awaits nothing.
  template <typename Condition>
  std::optional<Scan> pop(std::int64_t now_us, const Condition& is_awaiting) {
    const auto scan = first();
    return scan && (now_us > last_call_us(*scan) || !is_awaiting(*scan)) ? pop() : std::nullopt;
  }
  /// Until when the earliest scan may wait; nothing if there is none.
  [[nodiscard]] std::optional<std::int64_t> deadline_us() const {
    const auto scan = first();
    return scan ? std::optional(last_call_us(*scan)) : std::nullopt;
  }

 private:
  static std::int64_t last_call_us(const Scan& scan) { return scan.stamp_us + kLongestWaitUs; }
  [[nodiscard]] std::optional<Scan> first() const {
    std::optional<Scan> first;
    for (std::size_t radar = 0; radar < stamps_us_.size(); ++radar) {
      if (holds(radar) && (!first || *stamps_us_[radar] < first->stamp_us)) {
        first = Scan{radar, *stamps_us_[radar]};
      }
    }
    return first;
  }

  std::vector<std::optional<std::int64_t>> stamps_us_;  // By radar.
};

}  // namespace cremed
