// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/drive_command.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

#include "daemon/process/message_text.hpp"
#include "tools/eval/drive/baselines.hpp"
#include "tools/eval/drive/drive_json.hpp"
#include "tools/eval/drive/drive_report.hpp"
#include "tools/eval/drive/missing_time.hpp"
#include "tools/eval/drive/other_trajectory.hpp"
#include "tools/eval/input_file.hpp"
#include "tools/eval/plot.hpp"
#include "tools/eval/recorded_drive.hpp"
#include "tools/eval/temporary_folder.hpp"

namespace cremed {
namespace {

std::vector<std::string> write_tables(const std::string& folder,
                                      const std::vector<SourceEvaluation>& sources,
                                      const TrueTrajectory& truth) {
  std::vector<std::string> paths = table_paths(folder);
  write_sources_csv(paths[0], sources);
  write_truth_csv(paths[1], truth);
  write_path_csv(paths[2], sources, truth);
  write_errors_csv(paths[3], sources, truth);
  write_drift_csv(paths[4], sources);
  return paths;
}

void plot_drive(const std::vector<SourceEvaluation>& sources, const TrueTrajectory& truth,
                const std::string& picture) {
  const TemporaryFolder folder;
  draw_plot("plot_drive", write_tables(folder.file(""), sources, truth), picture);
}

void say_what_is_missing(const DriveFiles& files, const std::vector<SourceEvaluation>& sources,
                         const DriveReference& reference) {
  const TrueTrajectory& truth = reference.truth;
  for (const SourceEvaluation& source : sources) {
    const std::string spans = told_spans(source.availability.without, truth.utime_us().front());
    if (source.without_estimate + source.outside_truth != 0 || !spans.empty()) {
      std::fprintf(
          stderr, "%s: %zu rows without estimate, %zu estimates outside of truth's time%s\n",
          source.source.c_str(), source.without_estimate, source.outside_truth, spans.c_str());
    }
  }
  say_gaps(files.truth, truth.gaps(), truth.utime_us());
  if (reference.wheels) {
    say_gaps(files.wheels, reference.wheels->gaps(), reference.wheels->utime_us());
  }
}

bool any_compared(const std::vector<SourceEvaluation>& sources) {
  return std::ranges::any_of(sources,
                             [](const SourceEvaluation& source) { return !source.errors.empty(); });
}

/// Of all sources together.
TimeSpan drive_time(const std::vector<SourceEvaluation>& sources) {
  TimeSpan drive;
  for (const SourceEvaluation& source : sources) {
    const bool is_first = drive.end_us == 0;
    if (source.time.end_us != 0) {
      drive.begin_us =
          is_first ? source.time.begin_us : std::min(drive.begin_us, source.time.begin_us);
      drive.end_us = std::max(drive.end_us, source.time.end_us);
    }
  }
  return drive;
}

void check_overlap(const DriveFiles& files, const std::vector<SourceEvaluation>& sources,
                   const TrueTrajectory& truth) {
  const bool is_outside = std::ranges::any_of(
      sources, [](const SourceEvaluation& source) { return source.outside_truth != 0; });
  if (is_outside && !any_compared(sources)) {
    throw std::runtime_error(concat(
        {files.truth, ": its time, ", told_time(truth.utime_us()), ", has no motion of ",
         files.odometry, " in it; is it of the same drive, and in microseconds? The odometry has ",
         told_time(drive_time(sources))}));
  }
}

void check_wheels(const DriveFiles& files, const std::vector<SourceEvaluation>& sources,
                  const DriveReference& reference) {
  if (!reference.wheels || !any_compared(sources) ||
      std::ranges::any_of(
          sources, [](const SourceEvaluation& source) { return source.wheels->x.count != 0; })) {
    return;
  }
  if (reference.wheels->utime_us().empty()) {
    throw std::runtime_error(files.wheels + ": no row but the header");
  }
  throw std::runtime_error(concat(
      {files.wheels, ": its time, ", told_time(reference.wheels->utime_us()), ", has no motion of ",
       files.odometry,
       " in it that truth has too; is it of the same drive, and in microseconds? The odometry has ",
       told_time(drive_time(sources))}));
}

/// From the interval of a fast radar's scans to where the wheels' own error dominates.
constexpr std::array<std::int64_t, 6> kTruthIntervalsUs{75'000,    150'000,   300'000,
                                                        1'000'000, 2'000'000, 5'000'000};

DriveReference read_reference(const DriveFiles& files) {
  DriveReference reference;
  reference.truth = read_input<TrueTrajectory>(files.truth);
  reference.truth_noise = files.truth_noise;
  if (!files.wheels.empty()) {
    reference.wheels = with_input(
        files.wheels, [&](std::istream& input) { return WheelReference(input, files.wheels_std); });
  }
  return reference;
}

std::vector<TruthAgainstWheels> compare_references(const DriveReference& reference) {
  std::vector<TruthAgainstWheels> result;
  if (reference.wheels) {
    for (const std::int64_t interval_us : kTruthIntervalsUs) {
      result.push_back(truth_against_wheels(reference.truth, *reference.wheels, interval_us));
    }
  }
  return result;
}

void add_baselines(const DriveFiles& files, const DriveReference& reference,
                   std::vector<SourceEvaluation>& sources) {
  if (!files.baselines.empty()) {
    const Configuration configuration = load_configuration(files.config);
    const auto radars = record_drive(configuration, files.baselines).radars;
    for (const auto& odometry : baselines(configuration, radars)) {
      sources.push_back(evaluate_source(odometry, reference, sources.front().first_window_us));
    }
  }
}

void add_others(const DriveFiles& files, const DriveReference& reference,
                std::vector<SourceEvaluation>& sources) {
  const TimeSpan drive = drive_time(sources);
  for (const std::string& other : files.others) {
    const RecordedOdometry odometry = read_other_trajectory(other, drive);
    sources.push_back(evaluate_source(odometry, reference, sources.front().first_window_us));
    if (sources.back().errors.empty()) {
      throw std::runtime_error(
          concat({other, ": no pose within truth's time: it is ", told_time(sources.back().time),
                  ", truth's ", told_time(reference.truth.utime_us())}));
    }
  }
}

void print_tables(std::FILE* file, const std::vector<SourceEvaluation>& sources,
                  const DriveReference& reference, const std::vector<TruthAgainstWheels>& truth) {
  print_drive(file, sources, reference.truth_noise);
  print_segments(file, sources, reference.truth_noise);
  if (reference.wheels) {
    print_wheels(file, sources, *reference.wheels, truth);
  }
}

}  // namespace

std::vector<std::string> table_paths(const std::string& folder) {
  std::vector<std::string> paths;
  for (const char* name : {"sources.csv", "true_path.csv", "path.csv", "errors.csv", "drift.csv"}) {
    paths.push_back(std::filesystem::path(folder) / name);
  }
  return paths;
}

void run_drive(const DriveFiles& files) {
  const DriveReference reference = read_reference(files);
  auto sources = with_input(files.odometry,
                            [&](std::istream& input) { return evaluate_drive(input, reference); });
  if (sources.empty()) {
    throw std::runtime_error(files.odometry + ": no odometry");
  }
  check_overlap(files, sources, reference.truth);
  check_wheels(files, sources, reference);
  add_baselines(files, reference, sources);
  add_others(files, reference, sources);
  const auto print = files.as_json ? print_json : print_tables;
  print(stdout, sources, reference, compare_references(reference));
  say_what_is_missing(files, sources, reference);
  if (!files.truth_tum.empty()) {
    write_truth_tum(files.truth_tum, sources);
  }
  if (!files.tables.empty()) {
    write_tables(files.tables, sources, reference.truth);
  }
  if (!files.plot.empty()) {
    plot_drive(sources, reference.truth, files.plot);
  }
  if (!any_compared(sources)) {
    throw std::runtime_error(concat({files.odometry, ": no estimate in it"}));
  }
}

}  // namespace cremed
