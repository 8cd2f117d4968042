// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/run_replay.hpp"

#include <algorithm>
#include <csignal>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <spdlog/spdlog.h>

#include "cremed/estimator/scan/stamps.hpp"
#include "daemon/configuration/interfaces.hpp"
#include "daemon/configuration/learned_file.hpp"
#include "daemon/output/csv_writer.hpp"
#include "daemon/output/lcm_publisher.hpp"
#include "daemon/output/odometry_writer.hpp"
#include "daemon/output/tum_writer.hpp"
#include "daemon/pipeline.hpp"
#include "daemon/process/clocks.hpp"
#include "daemon/process/file_aliases.hpp"
#include "daemon/process/message_text.hpp"
#include "daemon/process/progress_bar.hpp"
#include "daemon/process/replaced_file.hpp"
#include "daemon/process/signals.hpp"
#include "daemon/process/usage_error.hpp"
#include "daemon/replay_report.hpp"
#include "daemon/source/replay.hpp"

namespace cremed {
namespace {

/// Never the configuration's: a vehicle would drive by the old odometry on the service's channels.
std::string lcm_url(const CommandLine& command_line) {
  return command_line.lcm_url.value_or("none");
}

/// The files with their names on the command line or in the configuration.
void refuse_overwriting(const CommandLine& command_line, const OutputConfiguration& output,
                        const std::string& configuration_path) {
  std::vector<NamedFile> inputs = {{"the configuration", configuration_path}};
  for (const std::string& log : command_line.replay) {
    inputs.push_back({"the log", log});
  }
  refuse_aliases(inputs, {{"--output-csv", output.csv},
                          {"--output-odometry", output.odometry},
                          {"--output-tum", output.tum},
                          {"--state-file", command_line.state_file.value_or("")},
                          {"LCM", lcm_file(lcm_url(command_line))}});
}

/// Checks the usage before anything is opened.
void refuse(const CommandLine& command_line, const std::string& configuration_path,
            const Configuration& configuration) {
  require_interface_names(configuration);
  if (!configuration.output.odometry.empty() && !configuration.odometry.enabled) {
    throw UsageError("there is no odometry to write: odometry.enabled = false");
  }
  refuse_overwriting(command_line, configuration.output, configuration_path);
}

struct Sinks {
  std::vector<std::unique_ptr<OdometrySink>> owned;
  LcmPublisher* publisher = nullptr;
  const TumWriter* tum = nullptr;
};

Sinks open_sinks(const CommandLine& command_line, const Configuration& configuration) {
  const OutputConfiguration& output = configuration.output;
  const std::string url = lcm_url(command_line);
  Sinks sinks;
  if (url != "none") {
    auto publisher = std::make_unique<LcmPublisher>(url, configuration);
    if (const std::string problem = publisher->connect(); !problem.empty()) {
      throw std::runtime_error(problem);
    }
    sinks.publisher = publisher.get();
    sinks.owned.push_back(std::move(publisher));
  }
  if (!output.csv.empty()) {
    std::vector<std::string> names;
    std::ranges::transform(configuration.radars, std::back_inserter(names),
                           &RadarConfiguration::name);
    sinks.owned.push_back(std::make_unique<CsvWriter>(output.csv, std::move(names)));
  }
  if (!output.odometry.empty()) {
    sinks.owned.push_back(std::make_unique<OdometryWriter>(output.odometry));
  }
  if (!output.tum.empty()) {
    auto writer = std::make_unique<TumWriter>(output.tum, tum_radar(configuration));
    sinks.tum = writer.get();
    sinks.owned.push_back(std::move(writer));
  }
  return sinks;
}

/// `prints`: rows go to standard output, which may be the terminal that would show the progress.
void take_all(Replay& replay, Pipeline& pipeline, bool prints) {
  constexpr std::uint64_t kFramesPerStep = 2000;
  std::optional<ProgressBar> progress;
  if (!prints) {
    progress.emplace("replay");
  }
  while (pipeline.take_next(replay)) {
    if (progress && replay.counters().frames % kFramesPerStep == 0) {
      progress->show(
          replay.share_read(),
          fmt::format("{} frames, {:.1f} s", replay.counters().frames, replay.traffic_s()));
    }
  }
}

/// As a shell gives it for a program that a signal ended.
constexpr int kSignalStatus = 128;

void report_interruption(const Replay& replay) {
  const auto share = replay.share_read();
  spdlog::error("interrupted after {:.1f} s of traffic{}: the outputs end there",
                replay.traffic_s(),
                share ? fmt::format(", {:.0f} % of the input", 100.0 * *share) : "");
}

bool report_sinks(const Sinks& sinks) {
  if (sinks.publisher != nullptr) {
    sinks.publisher->flush();
  }
  std::uint64_t failures = 0;
  for (const auto& sink : sinks.owned) {
    failures += sink->failures();
    if (const std::string problem = sink->problem(); !problem.empty()) {
      spdlog::error("{}", problem);
    }
  }
  if (failures != 0) {
    spdlog::error("{} results could not be written or published", failures);
  }
  if (sinks.tum != nullptr && sinks.tum->gaps() != 0) {
    spdlog::warn("the trajectory has {}, {}", counted(sinks.tum->gaps(), "gap"),
                 sinks.tum->is_of_radar() ? "at which it stands still"
                                          : "over which it is predicted, for max_gap_s at most");
  }
  return failures == 0;
}

}  // namespace

int run_replay(const CommandLine& command_line, const std::string& configuration_path,
               const Configuration& configuration) {
  refuse(command_line, configuration_path, configuration);
  const volatile std::sig_atomic_t* stop = handle_stop_signals();
  stop_at_hangup();
  Replay replay(command_line.replay, interface_names(configuration), command_line.speed, stop);
  std::optional<LearnedFile> learned;
  if (!command_line.state_file.value_or("").empty()) {
    learned.emplace(*command_line.state_file, configuration);
    learned->refuse_foreign();
    require_replaceable(learned->path());
  }
  const Sinks sinks = open_sinks(command_line, configuration);
  OdometryTally tally;
  std::vector<OdometrySink*> all_sinks{&tally};
  for (const auto& sink : sinks.owned) {
    all_sinks.push_back(sink.get());
  }
  Pipeline pipeline(
      configuration, replay, std::move(all_sinks),
      command_line.timing ? PipelineClock{&monotonic_us} : PipelineClock{},
      learned ? learned->read_and_log() : std::vector<std::optional<LearnedErrors>>());

  const std::int64_t begin_us = monotonic_us();
  take_all(replay, pipeline, configuration.output.csv == "-");
  const int stopped_by = *stop;
  pipeline.finish();
  const double wall_s = seconds_between(begin_us, monotonic_us());

  const double log_s = replay.traffic_s();
  spdlog::info("{} frames, {:.3f} s of traffic in {:.3f} s: {:.0f} times real time",
               replay.counters().frames, log_s, wall_s, log_s / wall_s);
  const bool input_good =
      report_replay({configuration_path, configuration, pipeline, replay, tally, stopped_by != 0});
  const bool output_good = report_sinks(sinks);
  if (const auto text = learned ? learned->text(pipeline.learned()) : std::nullopt) {
    replace_file(learned->path(), *text);
  }
  if (stopped_by != 0) {
    report_interruption(replay);
    return output_good ? kSignalStatus + stopped_by : 1;
  }
  return input_good && output_good ? 0 : 1;
}

}  // namespace cremed
