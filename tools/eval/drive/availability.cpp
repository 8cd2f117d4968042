// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/availability.hpp"

#include <algorithm>
#include <cstddef>

namespace cremed {
namespace {

constexpr std::int64_t kShortestPauseUs = 250'000;

std::int64_t longest_distance_us(const std::vector<RowTime>& rows) {
  std::vector<std::int64_t> distances_us;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    distances_us.push_back(rows[i].utime_us - rows[i - 1].utime_us);
  }
  if (distances_us.empty()) {
    return kShortestPauseUs;
  }
  const auto middle = distances_us.begin() + static_cast<std::ptrdiff_t>(distances_us.size() / 2);
  std::nth_element(distances_us.begin(), middle, distances_us.end());
  return std::max(kShortestPauseUs, 2 * *middle);
}

void add_span(const TimeSpan& span, std::vector<TimeSpan>& spans) {
  if (span.begin_us >= span.end_us) {
    return;
  }
  if (!spans.empty() && spans.back().end_us == span.begin_us) {
    spans.back().end_us = span.end_us;
  } else {
    spans.push_back(span);
  }
}

}  // namespace

Availability availability(const std::vector<RowTime>& rows, const TimeSpan& drive) {
  Availability result;
  const std::int64_t longest_us = longest_distance_us(rows);
  std::int64_t told_us = drive.begin_us;
  for (const RowTime& row : rows) {
    if (!row.is_usable || row.utime_us - told_us > longest_us) {
      add_span({told_us, row.utime_us}, result.without);
    }
    told_us = std::max(told_us, row.utime_us);
  }
  add_span({told_us, drive.end_us}, result.without);
  if (drive.end_us > drive.begin_us) {
    std::int64_t without_us = 0;
    for (const TimeSpan& span : result.without) {
      without_us += span.end_us - span.begin_us;
    }
    result.percent = 100.0 - 100.0 * static_cast<double>(without_us) /
                                 static_cast<double>(drive.end_us - drive.begin_us);
  }
  return result;
}

}  // namespace cremed
