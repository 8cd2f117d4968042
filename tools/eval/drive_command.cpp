// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive_command.hpp"

#include "tools/eval/drive_report.hpp"
#include "tools/eval/input_file.hpp"
#include "tools/eval/plot.hpp"
#include "tools/eval/temporary_folder.hpp"

namespace cremed {
namespace {

void plot_drive(const std::vector<SourceEvaluation>& sources, const TrueTrajectory& truth,
                const std::string& picture) {
  const TemporaryFolder folder;
  const std::vector<std::string> inputs{folder.file("sources.csv"), folder.file("truth.csv"),
                                        folder.file("path.csv"), folder.file("errors.csv"),
                                        folder.file("drift.csv")};
  write_sources_csv(inputs[0], sources);
  write_truth_csv(inputs[1], truth);
  write_path_csv(inputs[2], sources, truth);
  write_errors_csv(inputs[3], sources, truth);
  write_drift_csv(inputs[4], sources);
  draw_plot("plot_drive", inputs, picture);
}

void say_what_is_missing(const std::vector<SourceEvaluation>& sources) {
  for (const SourceEvaluation& source : sources) {
    if (source.without_estimate + source.outside_truth != 0) {
      std::fprintf(stderr, "%s: %zu rows without estimate, %zu estimates outside of truth's time\n",
                   source.source.c_str(), source.without_estimate, source.outside_truth);
    }
  }
}

}  // namespace

void run_drive(const DriveFiles& files) {
  const auto truth =
      with_input(files.truth, [](std::istream& input) { return TrueTrajectory(input); });
  const auto sources =
      with_input(files.odometry, [&](std::istream& input) { return evaluate_drive(input, truth); });
  if (sources.empty()) {
    throw std::runtime_error(files.odometry + ": no odometry");
  }
  print_drive(stdout, sources);
  say_what_is_missing(sources);
  if (!files.truth_tum.empty()) {
    write_truth_tum(files.truth_tum, sources);
  }
  if (!files.plot.empty()) {
    plot_drive(sources, truth, files.plot);
  }
}

}  // namespace cremed
