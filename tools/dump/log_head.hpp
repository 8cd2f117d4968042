// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "daemon/configuration/configuration.hpp"
#include "daemon/source/candump.hpp"
#include "tools/doctor/observer.hpp"

namespace cremed {

/// Keeps the first seconds of a log that cannot be read twice (a pipe), in which the radars that
/// are on the buses are recognised.
class LogHead {
 public:
  LogHead();

  void add(const CandumpLine& line);
  /// Every radar that was on has been seen.
  [[nodiscard]] bool is_complete() const { return is_complete_; }
  /// The radars in what was added of the log `path`. Throws std::runtime_error with advice if there
  /// are none. Call it once.
  [[nodiscard]] Configuration examined(const std::string& path);
  /// All lines that were added, in order.
  void replay(const std::function<void(const CandumpLine&)>& take) const;
  void clear() { lines_ = {}; }

 private:
  struct Kept {
    CandumpLine line;
    std::string interface;  // That of the line ends with it.
  };
  std::vector<Kept> lines_;
  Observer observer_;
  std::optional<std::int64_t> first_us_;
  bool is_complete_ = false;
};

}  // namespace cremed
