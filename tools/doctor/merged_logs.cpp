// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/merged_logs.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace cremed {
namespace {

/// A line that tells of losses has no stamp: it belongs to the line before it.
std::int64_t order_of(const CandumpLine& line) {
  return line.status == CandumpStatus::frame ? line.frame.stamp_us
                                             : std::numeric_limits<std::int64_t>::min();
}

}  // namespace

MergedLogs::MergedLogs(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    readers_.emplace_back(path);
  }
}

const CandumpLine* MergedLogs::next() {
  if (heads_.empty()) {
    heads_.resize(readers_.size());
    for (std::size_t log = 0; log < readers_.size(); ++log) {
      read(log);
    }
  } else {
    read(last_);
  }
  const auto earliest = std::ranges::min_element(heads_, [](const Head& a, const Head& b) {
    return a.is_there && (!b.is_there || order_of(a.line) < order_of(b.line));
  });
  last_ = static_cast<std::size_t>(earliest - heads_.begin());
  return earliest->is_there ? &earliest->line : nullptr;
}

void MergedLogs::read(std::size_t log) {
  Head& head = heads_[log];
  do {
    head.is_there = readers_[log].next(head.line);
  } while (head.is_there && head.line.status != CandumpStatus::frame &&
           head.line.status != CandumpStatus::dropped);
}

}  // namespace cremed
