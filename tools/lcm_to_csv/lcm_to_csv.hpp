// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "tools/line_file.hpp"

namespace cremed {

/// Content of an LCM log.
struct LcmLogCounters {
  std::uint64_t motions = 0;     ///< Rows written.
  std::uint64_t odometries = 0;  ///< Rows written.
  /// Of another type than the channel's, truncated, or out of range.
  std::uint64_t bad_messages = 0;
  /// Where the log is damaged, so that the rest was ignored; empty if it is not.
  std::string damage;
};

/// Writes each CREMED_EGO_MOTION of the log as a row of `cremed --output-csv` and, unless
/// `odometry_csv` is null, each CREMED_ODOMETRY as a row of `--output-odometry`. Throws
/// std::runtime_error if the log cannot be read.
LcmLogCounters lcm_to_csv(const std::string& log_path, LineFile& csv,
                          LineFile* odometry_csv = nullptr);

}  // namespace cremed
