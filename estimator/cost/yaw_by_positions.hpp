// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

namespace cremed {

/// Yaw between two scans by the positions of the targets alone, without Doppler, with any sideways
/// motion. NaN if they do not observe it.
struct YawByPositions {
  double rad = std::numeric_limits<double>::quiet_NaN();
  double variance_rad2 = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace cremed
