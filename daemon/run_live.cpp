// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/run_live.hpp"

#include <csignal>
#include <memory>

#include <spdlog/spdlog.h>

#include "daemon/configuration/configuration_summary.hpp"
#include "daemon/configuration/learned_file.hpp"
#include "daemon/live_session.hpp"
#include "daemon/process/clocks.hpp"
#include "daemon/process/file_aliases.hpp"
#include "daemon/process/instance_lock.hpp"
#include "daemon/process/message_text.hpp"
#include "daemon/process/real_time.hpp"
#include "daemon/process/signals.hpp"
#include "daemon/process/usage_error.hpp"
#include "daemon/report/service_notifier.hpp"

namespace cremed {
namespace {

std::string state_file(const CommandLine& command_line, const Configuration& configuration) {
  return command_line.state_file.value_or(
      configuration.odometry.enabled ? configuration.odometry.state_file : std::string());
}

/// A file would grow for months, and writing may block; lcm-logger records instead.
void refuse_files(const CommandLine& command_line, const Configuration& configuration) {
  if (command_line.output_csv || command_line.output_odometry || command_line.output_tum ||
      command_line.timing || command_line.speed != 0.0) {
    throw UsageError(
        "--output-csv, --output-odometry, --output-tum, --speed and --timing need --replay; record "
        "a live drive with "
        "`lcm-logger` and turn it into CSV with cremed-lcm-to-csv");
  }
  const OutputConfiguration& output = configuration.output;
  if (!output.csv.empty() || !output.odometry.empty() || !output.tum.empty()) {
    spdlog::warn(
        "output.csv, output.odometry and output.tum are written in replays only; record a live "
        "drive with "
        "`lcm-logger`");
  }
}

void set_up_real_time(RealTimePolicy policy) {
  if (policy == RealTimePolicy::off) {
    return;
  }
  const RealTimeState state = enter_real_time();
  const std::string problem = state.problem();
  if (problem.empty()) {
    spdlog::info("real time: priority {}, memory locked", state.priority);
  } else if (policy == RealTimePolicy::require) {
    throw UsageError("live.realtime is \"require\", but there is " + problem);
  } else {
    spdlog::warn("not real time: {}", problem);
  }
}

std::unique_ptr<LiveSession> begin(const CommandLine& command_line,
                                   const Configuration& configuration,
                                   const volatile std::sig_atomic_t* stop) {
  return std::make_unique<LiveSession>(configuration,
                                       command_line.lcm_url.value_or(configuration.output.lcm_url),
                                       state_file(command_line, configuration), stop);
}

/// A log of messages would fill the disk, be written between scans, and be emptied at each start.
void refuse_lcm_file(const std::string& url) {
  if (!lcm_file(url).empty()) {
    throw UsageError(concat({"output.lcm_url or --lcm-url is ", in_quotes(url),
                             ", which is for replays only; must be \"none\" or a URL such as ",
                             in_quotes(OutputConfiguration{}.lcm_url),
                             "; record a live drive with `lcm-logger`"}));
  }
}

/// The new configuration of the file, or nothing if it is invalid.
std::unique_ptr<Configuration> reload(const CommandLine& command_line, const std::string& path,
                                      RealTimePolicy real_time) {
  try {
    auto configuration = std::make_unique<Configuration>(load_configuration(path, command_line));
    refuse_outputs(command_line, path, *configuration);
    if (configuration->live.real_time != real_time) {
      spdlog::warn(
          "live.realtime has changed: that is used at the next start "
          "(`systemctl restart cremed`)");
    }
    return configuration;
  } catch (const UsageError& error) {
    spdlog::error("{}\nthe configuration is kept as it was", error.what());
    return nullptr;
  }
}

}  // namespace

/// The outputs of the live daemon besides messages.
void refuse_outputs(const CommandLine& command_line, const std::string& path,
                    const Configuration& configuration) {
  refuse_lcm_file(command_line.lcm_url.value_or(configuration.output.lcm_url));
  const std::string state = state_file(command_line, configuration);
  refuse_aliases({{"the configuration", path}}, {{"odometry.state_file", state}});
  if (!state.empty()) {
    LearnedFile(state, configuration).refuse_foreign();
  }
}

int run_live(const CommandLine& command_line, const std::string& path,
             const Configuration& configuration) {
  refuse_files(command_line, configuration);
  refuse_outputs(command_line, path, configuration);
  const InstanceLock lock(path);
  std::signal(SIGPIPE, SIG_IGN);  // The reader of the log may end first.
  const volatile std::sig_atomic_t* stop = handle_stop_signals();
  handle_reload_signal();
  if (configuration.live.real_time != RealTimePolicy::off) {
    keep_heap();
  }
  const ServiceNotifier notifier;
  std::unique_ptr<LiveSession> session = begin(command_line, configuration, stop);
  set_up_real_time(configuration.live.real_time);
  notifier.ready();

  const std::int64_t watch_us = notifier.watchdog_period_us();
  std::int64_t next_watchdog_us = 0;
  while (session->turn(notifier)) {
    if (watch_us > 0 && monotonic_us() >= next_watchdog_us) {
      notifier.watchdog();
      next_watchdog_us = monotonic_us() + watch_us;
    }
    if (take_reload_request()) {
      notifier.reloading();
      if (const auto changed = reload(command_line, path, configuration.live.real_time)) {
        session.reset();  // Two sessions must not use the same buses.
        session = begin(command_line, *changed, stop);
        spdlog::set_level(spdlog::level::from_str(changed->logging.level));
        log_configuration(path, *changed);
      }
      notifier.ready();
    }
  }
  notifier.stopping();
  session->finish();
  spdlog::info("asked to stop");
  return 0;
}

}  // namespace cremed
