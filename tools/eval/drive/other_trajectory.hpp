// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/eval/drive/recorded_odometry.hpp"

namespace cremed {

/// The trajectory of another system, as its steps from pose to pose, named after the file. Their
/// covariance is unknown: NaN. Poses farther apart than longest_step_us are a gap. Availability is
/// that in the drive's time. Throws std::runtime_error.
///
/// "FILE" in TUM format: time in s, x y z, quaternion x y z w; x forward, y left. "FILE,TIMES" in
/// KITTI's: of each pose the 12 numbers of [R t] by rows, in a camera's axes (x right, z forward),
/// and its time in s on the same line of TIMES. Both are projected to the plane.
RecordedOdometry read_other_trajectory(const std::string& files, const TimeSpan& drive);

}  // namespace cremed
