// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace cremed {

/// Indices of the estimated states: (x, yaw) in 2 DoF, (x, y, yaw) in 3.
const std::vector<Eigen::Index>& free_states(int degrees_of_freedom);

/// Inverse of the estimated states' block, zeros elsewhere; nothing if it is not positive definite.
std::optional<Eigen::Matrix3d> invert_free(const Eigen::Matrix3d& information,
                                           int degrees_of_freedom);

}  // namespace cremed
