// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace cremed {

/// Draws the trajectories of a drive with truth into `picture`, by the script plot_drive (Python,
/// matplotlib) that is installed with cremed-eval. Throws std::runtime_error.
void plot_drive(const std::string& odometry, const std::string& truth, const std::string& picture);

}  // namespace cremed
