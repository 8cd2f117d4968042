// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "tools/eval/chi_square.hpp"

namespace cremed {

struct TimedNees {
  std::int64_t utime_us = 0;
  double nees = 0.0;  ///< Per degree of freedom.
};

/// Mean of NEES over a window, and the 95 % interval of such means for credible, independent
/// estimates. (Neighbours share a scan, so slightly more lie outside.)
struct RunningNees {
  double mean = 0.0;
  Interval interval;
};

/// For each estimate, in order of time, the mean of those at most half a window away.
std::vector<RunningNees> running_nees(const std::vector<TimedNees>& estimates,
                                      int degrees_of_freedom, std::int64_t window_us);

}  // namespace cremed
