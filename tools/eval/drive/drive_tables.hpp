// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <vector>

#include "tools/eval/drive/drive_evaluation.hpp"

namespace cremed {

/// Table below a drive's figures, as comments: the pose after a distance or a time.
void print_segments(std::FILE* file, const std::vector<SourceEvaluation>& sources,
                    const TruthNoise& noise);

/// Each source's x and yaw against the wheels with the split of NEES, the twist if there is one,
/// and truth against the wheels.
void print_wheels(std::FILE* file, const std::vector<SourceEvaluation>& sources,
                  const WheelReference& wheels, const std::vector<TruthAgainstWheels>& truth);

}  // namespace cremed
