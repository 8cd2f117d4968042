// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <istream>
#include <string>
#include <vector>

#include "tools/eval/credibility.hpp"
#include "tools/eval/true_trajectory.hpp"

namespace cremed {

/// One source's odometry against truth.
struct SourceEvaluation {
  std::string source;
  Credibility credibility;
  std::size_t without_estimate = 0;  ///< Rows whose status says that there is no estimate.
  std::size_t outside_truth = 0;     ///< Estimates that truth does not cover in time.
};

/// Reads odometry CSV as cremed writes it and compares every estimate with truth; sources in order
/// of appearance. A source whose cov_yy is 0 throughout is taken as 2 DoF. Throws
/// std::runtime_error.
std::vector<SourceEvaluation> evaluate_drive(std::istream& odometry, const TrueTrajectory& truth);

}  // namespace cremed
