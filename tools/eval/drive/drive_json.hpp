// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tools/eval/credibility.hpp"
#include "tools/eval/drive/drive_evaluation.hpp"

namespace cremed {

/// For scripts; NaN becomes null. Members keep their order.
nlohmann::ordered_json credibility_json(const Credibility& credibility);

/// The output of cremed-eval drive as one JSON object: "sources" in order of appearance, with
/// "drift", "segments" and, with wheels, "wheels" and "twist"; then "truth_std", "truth_gaps",
/// "wheels_std", "wheels_gaps" and "truth_against_wheels". Names carry units; missing values are
/// null.
void print_json(std::FILE* file, const std::vector<SourceEvaluation>& sources,
                const DriveReference& reference, const std::vector<TruthAgainstWheels>& truth);

}  // namespace cremed
