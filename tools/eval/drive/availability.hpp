// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace cremed {

/// A row of a recorded odometry, and whether it has a usable estimate.
struct RowTime {
  std::int64_t utime_us = 0;
  bool is_usable = false;
};

struct TimeSpan {
  std::int64_t begin_us = 0;
  std::int64_t end_us = 0;
};

struct Availability {
  double percent = std::numeric_limits<double>::quiet_NaN();  ///< Of the drive's time.
  std::vector<TimeSpan> without;                              ///< In order.
};

/// For how much of the drive there was a usable estimate: a usable row tells of the time since the
/// row before it, unless that is a pause: longer than 0.25 s, after which the odometry predicts
/// only, and than twice the usual distance of rows (their median). tools/report/availability.py
/// does the same.
Availability availability(const std::vector<RowTime>& rows, const TimeSpan& drive);

}  // namespace cremed
