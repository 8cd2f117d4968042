// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/eval/drive/time_bracket.hpp"

namespace cremed {

/// ", nothing from 20.1 s to 22.0 s and 2 times more", counted from `begin_us`; nothing of what
/// lacks for less than half a second.
std::string told_spans(const std::vector<TimeSpan>& without, std::int64_t begin_us);

/// "truth.csv: 1.9 s are missing, nothing from 20.1 s to 22.0 s" on standard error, in the file's
/// time. So it says that rows are usually too far apart.
void say_gaps(const std::string& path, const std::vector<TimeSpan>& gaps,
              const std::vector<std::int64_t>& utime_us);

/// "utime 1000000 to 2000000".
std::string told_time(const TimeSpan& time);
std::string told_time(const std::vector<std::int64_t>& utime_us);

}  // namespace cremed
