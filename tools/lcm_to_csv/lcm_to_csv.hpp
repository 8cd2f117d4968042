// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>

namespace cremed {

/// What an LCM log held.
struct LcmLogCounters {
  std::uint64_t motions = 0;         ///< Written as a row.
  std::uint64_t odometries = 0;      ///< Written as a row.
  std::uint64_t bad_messages = 0;    ///< Of another type on its channel, cut off, or out of range.
  bool ends_inside_message = false;  ///< What follows the last whole message is not read.
};

/// Writes each CREMED_EGO_MOTION of the log, in the log's order, as the row that
/// `cremed --output-csv` writes, and unless `odometry_csv` is null each CREMED_ODOMETRY as that of
/// `--output-odometry`. Throws std::runtime_error if the log cannot be read.
LcmLogCounters lcm_to_csv(const std::string& log_path, std::ostream& csv,
                          std::ostream* odometry_csv = nullptr);

}  // namespace cremed
