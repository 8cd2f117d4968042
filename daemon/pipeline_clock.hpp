// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace cremed {

/// Clock for durations; one that stands still, if it is not set, measures none.
struct PipelineClock {
  std::int64_t (*now_us)() = [] { return std::int64_t{0}; };
  /// true: `now_us` is the clock of the stamps, and latency counts from the stamp of a scan's last
  /// frame; false: from the call of on_frame().
  bool is_stamp_clock = false;
};

}  // namespace cremed
