// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "tools/eval/drive/drive_evaluation.hpp"

namespace cremed {

/// Prints a line of figures per source, then, as comments, its drift over distance.
void print_drive(std::FILE* file, const std::vector<SourceEvaluation>& sources,
                 const TruthNoise& noise);

/// Writes the input of plot_drive as CSV files; throws std::runtime_error.
void write_truth_csv(const std::string& path, const TrueTrajectory& truth);
void write_sources_csv(const std::string& path, const std::vector<SourceEvaluation>& sources);
/// Seconds and metres count from truth's first pose, in both functions.
void write_errors_csv(const std::string& path, const std::vector<SourceEvaluation>& sources,
                      const TrueTrajectory& truth);
void write_path_csv(const std::string& path, const std::vector<SourceEvaluation>& sources,
                    const TrueTrajectory& truth);
void write_drift_csv(const std::string& path, const std::vector<SourceEvaluation>& sources);

/// Writes the true poses at the ends of all estimates in TUM format, for programs that match equal
/// times. Throws std::runtime_error.
void write_truth_tum(const std::string& path, const std::vector<SourceEvaluation>& sources);

/// Table below a drive's figures, as comments: the pose after a distance or a time.
void print_segments(std::FILE* file, const std::vector<SourceEvaluation>& sources,
                    const TruthNoise& noise);

/// Each source's x and yaw against the wheels with the split of NEES, the twist if there is one,
/// and truth against the wheels.
void print_wheels(std::FILE* file, const std::vector<SourceEvaluation>& sources,
                  const WheelReference& wheels, const std::vector<TruthAgainstWheels>& truth);

}  // namespace cremed
