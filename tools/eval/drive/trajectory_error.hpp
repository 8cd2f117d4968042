// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "tools/eval/drive/path_drift.hpp"

namespace cremed {

/// RMS distances between the path and truth, which evo calls APE; NaN without a path.
struct TrajectoryError {
  double from_begin_m = 0.0;  ///< The path begins at the first true pose (evo: --align_origin).
  double aligned_m = 0.0;     ///< Moved and turned to where they are least (--align).
};

TrajectoryError trajectory_error(const std::vector<PathPose>& path);

}  // namespace cremed
