// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "tools/eval/drive/drive_evaluation.hpp"

namespace cremed {

/// Prints a line of figures a source, then, as comments, how far each drifts over distance.
void print_drive(std::FILE* file, const std::vector<SourceEvaluation>& sources,
                 const TruthNoise& noise);

/// Writes what plot_drive draws, as CSV files; throws std::runtime_error.
void write_truth_csv(const std::string& path, const TrueTrajectory& truth);
void write_sources_csv(const std::string& path, const std::vector<SourceEvaluation>& sources);
/// Seconds and metres are counted from truth's first pose, in these two as well.
void write_errors_csv(const std::string& path, const std::vector<SourceEvaluation>& sources,
                      const TrueTrajectory& truth);
void write_path_csv(const std::string& path, const std::vector<SourceEvaluation>& sources,
                    const TrueTrajectory& truth);
void write_drift_csv(const std::string& path, const std::vector<SourceEvaluation>& sources);

/// Writes the true poses at the ends of all estimates in TUM format, so that a program that looks
/// for equal times need not interpolate. Throws std::runtime_error.
void write_truth_tum(const std::string& path, const std::vector<SourceEvaluation>& sources);

}  // namespace cremed
