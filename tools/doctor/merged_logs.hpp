// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <vector>

#include "daemon/source/candump_reader.hpp"

namespace cremed {

/// The lines of candump logs, one per bus, as one log: by stamp. Each log stays in its order.
class MergedLogs {
 public:
  /// Throws std::runtime_error if one cannot be opened or has another format.
  explicit MergedLogs(const std::vector<std::string>& paths);

  /// The next line, valid until the next call; null at the end.
  const CandumpLine* next();

  [[nodiscard]] const std::deque<CandumpReader>& readers() const { return readers_; }

 private:
  void read(std::size_t log);

  struct Head {
    CandumpLine line;
    bool is_there = false;
  };
  std::deque<CandumpReader> readers_;
  std::vector<Head> heads_;  // The next line of each log.
  std::size_t last_ = 0;     // The log whose line was handed out.
};

}  // namespace cremed
