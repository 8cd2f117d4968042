// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "daemon/configuration/configuration.hpp"
#include "daemon/configuration/configuration_path.hpp"
#include "daemon/process/joined.hpp"
#include "daemon/process/message_text.hpp"
#include "daemon/process/usage_error.hpp"
#include "daemon/source/candump_reader.hpp"
#include "tools/doctor/interface_search.hpp"
#include "tools/doctor/log_observation.hpp"
#include "tools/doctor/observer.hpp"
#include "tools/doctor/unconfigured.hpp"
#include "tools/dump/record_writer.hpp"
#include "tools/dump/scan_reader.hpp"
#include "tools/program.hpp"

namespace {

using namespace cremed;

enum ExitStatus : int { good = 0, failure = 1 };

struct Arguments {
  std::string log;
  std::string config;
  std::string radar;
  bool is_json = false;
  bool without_targets = false;
};

/// With the radar that was asked for only.
Configuration selected(const std::string& wanted, Configuration configuration) {
  const std::string names = joined(configuration.radars, &RadarConfiguration::name);
  std::erase_if(configuration.radars, [&](const RadarConfiguration& radar) {
    return !wanted.empty() && radar.name != wanted;
  });
  if (configuration.radars.empty()) {
    throw UsageError(concat({"--radar: ", in_quotes(wanted), " is none of ", names}));
  }
  return configuration;
}

/// The radars observed, as they are, of which one may be wanted only. Throws std::runtime_error
/// with advice if there are none.
LocatedRadars as_sent(const Observation& observation, const std::string& wanted) {
  LocatedRadars radars = examined_radars(observation, ExaminedOutput::as_sent);
  radars.configuration = selected(wanted, std::move(radars.configuration));
  return radars;
}

/// Nothing: the radars are to be found in the log itself, while it is read.
std::optional<LocatedRadars> located(const Arguments& arguments) {
  if (!is_unconfigured(arguments.config)) {
    return locate_in_logs(
        selected(arguments.radar, load_configuration(configuration_path(arguments.config))),
        {arguments.log});
  }
  if (is_pipe(arguments.log)) {
    return std::nullopt;
  }
  return as_sent(observe_logs(without_radars(), {arguments.log}), arguments.radar);
}

/// The longest period of a radar's messages is a second.
constexpr std::int64_t kHeadUs = 2'000'000;
/// More than five full buses carry in that time, 111 us a frame at 1 Mbit/s.
constexpr std::size_t kMostLines = 100'000;

/// Keeps the first seconds of a log that cannot be read twice (a pipe), in which the radars that
/// are on the buses are recognised.
class LogHead {
 public:
  void add(const CandumpLine& line) {
    lines_.push_back({line, std::string(line.interface_name)});
    if (line.status == CandumpStatus::frame) {
      observer_.add(line.interface_name, line.frame);
      first_us_ = first_us_.value_or(line.frame.stamp_us);
      is_complete_ = line.frame.stamp_us >= *first_us_ + kHeadUs;
    }
    is_complete_ = is_complete_ || lines_.size() >= kMostLines;
  }
  /// Every radar that was on has been seen.
  [[nodiscard]] bool is_complete() const { return is_complete_; }
  /// The radars in what was added of `log`, as as_sent(). Call it once.
  [[nodiscard]] LocatedRadars examined(const CandumpReader& log, const std::string& wanted) {
    if (!first_us_) {
      throw std::runtime_error(log.no_frame());
    }
    return as_sent(observer_.finish(), wanted);
  }
  /// All lines that were added, in order; they are kept no longer.
  void hand_over(ScanReader& reader) {
    for (Kept& kept : lines_) {
      kept.line.interface_name = kept.interface;
      reader.add(kept.line);
    }
    lines_ = {};
  }

 private:
  struct Kept {
    CandumpLine line;
    std::string interface;  // That of the line ends with it.
  };
  std::vector<Kept> lines_;
  Observer observer_{without_radars()};
  std::optional<std::int64_t> first_us_;
  bool is_complete_ = false;
};

/// Reads the log once; without a configuration, its head tells the radars.
class Dump {
 public:
  explicit Dump(const Arguments& arguments)
      : arguments_(arguments),
        log_(arguments.log),
        writer_(make_record_writer(
            std::cout, {arguments.is_json, !arguments.without_targets, is_pipe(arguments.log)})) {
    if (const auto known = located(arguments)) {
      read(*known);
    }
  }

  void run() {
    for (CandumpLine line; log_.next(line);) {
      take(line);
    }
    if (!reader_) {
      end_head();
    }
    reader_->finish();
  }

  /// Tells what one may miss in the output. Whether it is complete.
  [[nodiscard]] bool report() const {
    const std::string silent = reader_->silent();
    const std::string reasons[] = {
        log_.malformed(), log_.problem(),
        silent.empty() ? ""
                       : concat({"no scan of ", silent, "; `cremed-doctor --replay ",
                                 in_shell(arguments_.log), "` tells why"})};
    if (const std::string cut_off = log_.cut_off(); !cut_off.empty()) {
      std::cerr << "cremed-dump: " << cut_off << '\n';
    }
    bool is_complete = are_located_;
    for (const std::string& reason : reasons) {
      if (!reason.empty()) {
        std::cerr << "cremed-dump: " << reason << '\n';
        is_complete = false;
      }
    }
    return is_complete;
  }

 private:
  void read(const LocatedRadars& radars) {
    for (const Finding& finding : radars.findings) {
      std::cerr << "cremed-dump: " << to_text(finding) << '\n';
    }
    are_located_ = radars.findings.empty();
    reader_.emplace(radars.configuration, *writer_);
  }

  void end_head() {
    read(head_.examined(log_, arguments_.radar));
    head_.hand_over(*reader_);
  }

  void take(const CandumpLine& line) {
    if (reader_) {
      reader_->add(line);
      return;
    }
    head_.add(line);
    if (head_.is_complete()) {
      end_head();
    }
  }

  const Arguments& arguments_;
  CandumpReader log_;
  std::unique_ptr<RecordWriter> writer_;
  bool are_located_ = true;  // All radars of the configuration, or of the log.
  LogHead head_;
  std::optional<ScanReader> reader_;
};

int run(CLI::App& app, int argc, char** argv) {
  Arguments arguments;
  app.footer(
      "Examples:\n"
      "  What a bus says now, as JSON.\n"
      "    $ candump -L can0 | cremed-dump - --json\n"
      "\n"
      "Files:\n"
      "  /etc/cremed/cremed.toml     Configuration of the service");
  app.add_option("LOG", arguments.log, "Log of `candump -L` or `-l`; - for standard input")
      ->type_name("FILE")
      ->required();
  app.add_option("--config", arguments.config,
                 "Configuration (default: /etc/cremed/cremed.toml; if that names no radar, all "
                 "that are recognised in the log)")
      ->type_name("FILE");
  app.add_option("--radar", arguments.radar, "Only the radar of this name")->type_name("NAME");
  app.add_flag("--json", arguments.is_json, "One JSON object a line");
  app.add_flag("--no-targets", arguments.without_targets, "Scans without their targets");
  app.parse(argc, argv);
  Dump dump(arguments);
  dump.run();
  return dump.report() ? good : failure;
}

}  // namespace

int main(int argc, char** argv) {
  return cremed::run_program("cremed-dump",
                             "Prints the radar scans in a log of CAN frames\n"
                             "Speed and yaw rate sent to an ARS408, or named in [vehicle], too.",
                             run, argc, argv);
}
