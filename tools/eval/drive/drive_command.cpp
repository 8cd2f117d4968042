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

/// Shorter ones are a scan or two.
constexpr std::int64_t kLongSpanUs = 500'000;
constexpr std::size_t kMostSpans = 3;

/// ", nothing from 20.1 s to 22.0 s and 2 times more", in truth's time, as the tables have it.
std::string told(const std::vector<TimeSpan>& without, std::int64_t begin_us) {
  const auto seconds = [&](std::int64_t utime_us) {
    return tenths(static_cast<double>(utime_us - begin_us) * 1e-6) + " s";
  };
  std::string text;
  std::size_t count = 0;
  for (const TimeSpan& span : without) {
    if (span.end_us - span.begin_us >= kLongSpanUs && ++count <= kMostSpans) {
      text += concat({count == 1 ? ", nothing from " : ", from ", seconds(span.begin_us), " to ",
                      seconds(span.end_us)});
    }
  }
  return count <= kMostSpans
             ? text
             : concat({text, " and ", counted(count - kMostSpans, "time"), " more"});
}

void say_what_is_missing(const std::vector<SourceEvaluation>& sources,
                         const TrueTrajectory& truth) {
  for (const SourceEvaluation& source : sources) {
    const std::string spans = told(source.availability.without, truth.utime_us().front());
    if (source.without_estimate + source.outside_truth != 0 || !spans.empty()) {
      std::fprintf(
          stderr, "%s: %zu rows without estimate, %zu estimates outside of truth's time%s\n",
          source.source.c_str(), source.without_estimate, source.outside_truth, spans.c_str());
    }
  }
}

bool any_compared(const std::vector<SourceEvaluation>& sources) {
  return std::ranges::any_of(sources,
                             [](const SourceEvaluation& source) { return !source.errors.empty(); });
}

void check_overlap(const DriveFiles& files, const std::vector<SourceEvaluation>& sources,
                   const TrueTrajectory& truth) {
  const bool is_outside = std::ranges::any_of(
      sources, [](const SourceEvaluation& source) { return source.outside_truth != 0; });
  if (is_outside && !any_compared(sources)) {
    throw std::runtime_error(
        concat({files.truth, ": its time, utime ", std::to_string(truth.utime_us().front()), " to ",
                std::to_string(truth.utime_us().back()), ", has no motion of ", files.odometry,
                " in it; is it of the same drive, and in microseconds?"}));
  }
}

/// From the interval of a fast radar's scans to where the wheels' own error dominates.
constexpr std::array<std::int64_t, 6> kTruthIntervalsUs{75'000,    150'000,   300'000,
                                                        1'000'000, 2'000'000, 5'000'000};

DriveReference read_reference(const DriveFiles& files) {
  DriveReference reference;
  reference.truth =
      with_input(files.truth, [](std::istream& input) { return TrueTrajectory(input); });
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
    const auto radars = record_drive(configuration, files.baselines);
    for (const auto& odometry : baselines(configuration, radars)) {
      sources.push_back(evaluate_source(odometry, reference, sources.front().first_window_us));
    }
  }
}

void add_others(const DriveFiles& files, const DriveReference& reference,
                std::vector<SourceEvaluation>& sources) {
  for (const std::string& other : files.others) {
    const RecordedOdometry odometry = read_other_trajectory(other);
    sources.push_back(evaluate_source(odometry, reference, sources.front().first_window_us));
    if (sources.back().errors.empty()) {
      throw std::runtime_error(other + ": no pose within truth's time");
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
  add_baselines(files, reference, sources);
  add_others(files, reference, sources);
  const auto print = files.as_json ? print_json : print_tables;
  print(stdout, sources, reference, compare_references(reference));
  say_what_is_missing(sources, reference.truth);
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
