// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace cremed {

/// The longest delay of candump between frames of several interfaces.
inline constexpr std::int64_t kLongestDisorderUs = 500'000;

/// Whether the stamps of a log are times. Those of one interface never run backwards, unless the
/// clock was set; the times between frames of `candump -td` do, and so do shuffled lines. A log
/// that was written without times may have one stamp throughout. Logs of one interface each that
/// were joined end to end have the time of the drive more than once.
class StampOrder {
 public:
  void add(std::string_view interface, std::int64_t stamp_us);

  /// Why no time is in the stamps of the log at `path`, with a remedy; empty if it is.
  [[nodiscard]] std::string problem(const std::string& path) const;

 private:
  struct Interface {
    std::string name;
    std::int64_t last_us = 0;
  };
  static constexpr std::size_t kMostInterfaces = 32;  // Further ones are not looked at.

  std::vector<Interface> interfaces_;
  bool is_joined_ = false;  ///< One interface ended before an earlier stamp of the next.
  std::uint64_t steps_ = 0;
  std::uint64_t steps_still_ = 0;
  std::uint64_t steps_back_ = 0;
  std::int64_t latest_us_ = 0;
};

}  // namespace cremed
