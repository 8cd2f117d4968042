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

/// Mean of NEES over a window, and where 95 % of such means lie if the covariances are credible and
/// the estimates independent. (Neighbours share a scan, so a few more lie outside.)
struct RunningNees {
  double mean = 0.0;
  Interval interval;
};

/// For each of them, in order of time, the mean of those at most half a window away.
std::vector<RunningNees> running_nees(const std::vector<TimedNees>& estimates,
                                      int degrees_of_freedom, std::int64_t window_us);

}  // namespace cremed
