// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <csignal>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "daemon/command_line.hpp"
#include "daemon/configuration/configuration.hpp"
#include "daemon/configuration/configuration_path.hpp"
#include "daemon/configuration/first_configuration.hpp"
#include "daemon/configuration/interfaces.hpp"
#include "daemon/configuration/lcm_url.hpp"
#include "daemon/output/multicast_route.hpp"
#include "daemon/process/joined.hpp"
#include "daemon/process/signals.hpp"
#include "daemon/process/usage_error.hpp"
#include "daemon/report/report.hpp"
#include "tools/doctor/ars408_filters.hpp"
#include "tools/doctor/ars408_setup.hpp"
#include "tools/doctor/bus_findings.hpp"
#include "tools/doctor/diagnosis.hpp"
#include "tools/doctor/interface_search.hpp"
#include "tools/doctor/live_observation.hpp"
#include "tools/doctor/log_observation.hpp"
#include "tools/doctor/suggestion.hpp"
#include "tools/doctor/unconfigured.hpp"
#include "tools/program.hpp"

namespace {

using namespace cremed;

enum ExitStatus : int { good = 0, failure = 1 };

constexpr const char* kLive = "live";

struct Arguments {
  std::string config;
  std::string suggested_from;
  bool is_json = false;
  double seconds = 3.0;
  std::vector<std::string> replay;
  std::optional<std::string> lcm_url;
  std::string ars408;
  std::string filtered;
  std::vector<std::string> filters;
  Ars408TalkOptions talk;
  Ars408Setup setup;
};

void add_diagnosis_options(CLI::App& app, Arguments& arguments) {
  app.add_option("--config", arguments.config, "Configuration (default: /etc/cremed/cremed.toml)")
      ->type_name("FILE");
  app.add_option("--seconds", arguments.seconds, "How long to listen")
      ->check(number_in(0.1, 3600.0))
      ->capture_default_str();
  app.add_option(
         "--replay", arguments.replay,
         "Diagnose a candump log instead of the live bus; - for standard input; may repeat: "
         "the logs of one drive, merged by stamp")
      ->type_name("FILE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--lcm-url", arguments.lcm_url,
                 "LCM URL to check, or none; overrides the configuration. With a log LCM is "
                 "checked only if this is given")
      ->type_name("URL");
}

void add_other_outputs(CLI::App& app, Arguments& arguments) {
  auto* json = app.add_flag("--json", arguments.is_json, "Print the diagnosis as JSON");
  app.add_option(
         "--suggest-config", arguments.suggested_from,
         "Write a first configuration of the radars on the buses (live), or in the log of "
         "--replay, to standard output; the mounts must be filled in. The log may also follow here")
      ->type_name("[FILE]")
      ->expected(0, 1)
      ->default_str(kLive)
      ->excludes("--config")
      ->excludes("--lcm-url")
      ->excludes(json);
}

std::string name_problem(const std::string& name) {
  return name.empty() ? "must be the name of a radar" : std::string();
}

void add_talk_options(CLI::App& app, Arguments& arguments) {
  auto* configure = app.add_option("--configure-ars408", arguments.ars408,
                                   "Set the sensor of this radar as the configuration "
                                   "expects; asks before it sends")
                        ->type_name("NAME")
                        ->check(name_problem);
  app.add_option("--max-distance", arguments.setup.max_distance_m,
                 "Also set its range in m (by model 196 to 260, or up to 1200)")
      ->check(number_in(196.0, 1200.0))
      ->needs(configure);
  app.add_flag("--store", arguments.setup.store,
               "Write its settings to its flash, to keep them after power-off")
      ->needs(configure);
  auto* filtered = app.add_option("--ars408-filters", arguments.filtered,
                                  "Show which clusters the filters of this radar's sensor pass; "
                                  "asks before it sends the request")
                       ->type_name("NAME")
                       ->check(name_problem);
  app.add_option("--filter", arguments.filters,
                 std::string("Set a filter, also in the sensor's flash; may repeat: ") +
                     kArs408FilterWanted)
      ->type_name("FILTER")
      ->needs(filtered)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--sensor-id", arguments.talk.address.said_id,
                 "The sensor's present id, if it is not the configured one")
      ->check(CLI::Range(0, 7));
  app.add_flag("--yes", arguments.talk.consent.is_given, "Send without asking");
  for (const char* other : {"--replay", "--json", "--suggest-config"}) {
    configure->excludes(other);
    filtered->excludes(other);
  }
  configure->excludes(filtered);
}

bool is_talk(const Arguments& arguments) {
  return !arguments.ars408.empty() || !arguments.filtered.empty();
}

void print(const Finding& finding) {
  std::cout << severity_name(finding.severity) << ": " << to_text(finding) << '\n';
}

bool finds_radars(const Arguments& arguments) { return is_unconfigured(arguments.config); }

Observation observe(const Arguments& arguments, const Configuration& configuration,
                    const volatile std::sig_atomic_t* stop) {
  Observation observation = arguments.replay.empty()
                                ? observe_live(configuration, arguments.seconds, stop)
                                : observe_logs(configuration, arguments.replay);
  if (finds_radars(arguments)) {
    drop_doubts_of_mounts(observation);
  }
  if (reversed_odometry(observation.odometry, configuration.radars.size())) {
    drop_doubts_of_turned_mount(observation.radars.front().status);
  }
  const bool asks_for_lcm = arguments.replay.empty() || arguments.lcm_url;
  if (asks_for_lcm) {
    observation.lcm_problem =
        multicast_problem(arguments.lcm_url.value_or(configuration.output.lcm_url));
  }
  return observation;
}

/// Whatever is on the buses (no `logs`), or in the logs.
Observation observe_anything(const std::vector<std::string>& logs, double seconds,
                             const volatile std::sig_atomic_t* stop) {
  return logs.empty() ? observe_live(without_radars(), seconds, stop)
                      : observe_logs(without_radars(), logs);
}

LocatedRadars locate(const Arguments& arguments, const volatile std::sig_atomic_t* stop) {
  if (finds_radars(arguments)) {
    if (std::ranges::any_of(arguments.replay, is_pipe)) {
      throw UsageError(
          "--replay: a pipe cannot be read twice, first for its radars; name a file, or "
          "the radars by --config FILE");
    }
    return found_radars(observe_anything(arguments.replay, arguments.seconds, stop));
  }
  const Configuration asked = load_configuration(configuration_path(arguments.config));
  return stop != nullptr ? locate_live(asked, stop) : locate_in_logs(asked, arguments.replay);
}

int run_diagnosis(const Arguments& arguments) {
  // Live, a signal ends the observation; with a log it ends the program.
  const auto* const stop = arguments.replay.empty() ? handle_stop_signals() : nullptr;
  const LocatedRadars located = locate(arguments, stop);
  const Configuration& configuration = located.configuration;
  const Observation observation = observe(arguments, configuration, stop);
  std::vector<Finding> findings = located.findings;
  const std::vector<Finding> diagnosed = diagnose(configuration, observation);
  findings.insert(findings.end(), diagnosed.begin(), diagnosed.end());
  std::ranges::stable_sort(findings, {}, &Finding::severity);
  const bool all_well = is_well(findings);
  if (arguments.is_json) {
    std::cout << diagnosis_json(configuration, observation, findings) << '\n';
    return all_well ? good : failure;
  }
  std::ranges::for_each(findings, print);
  for (std::size_t i = 0; i < configuration.radars.size(); ++i) {
    std::cout << (all_well ? "good: " : "")
              << vital_signs(configuration.radars[i], observation.radars[i], observation.seconds)
              << '\n';
  }
  return all_well ? good : failure;
}

/// Of either option; empty: live.
std::vector<std::string> suggested_logs(const Arguments& arguments) {
  if (arguments.suggested_from == kLive) {
    return arguments.replay;
  }
  if (!arguments.replay.empty()) {
    throw UsageError("--suggest-config and --replay name a log each: leave one out");
  }
  return {arguments.suggested_from};
}

int run_suggestion(const Arguments& arguments) {
  const std::vector<std::string> logs = suggested_logs(arguments);
  const Observation observation =
      observe_anything(logs, arguments.seconds, logs.empty() ? handle_stop_signals() : nullptr);
  const std::string suggestion = suggested_configuration(observation);
  if (suggestion.empty()) {
    std::cerr << "cremed-doctor: " << no_suggestion(observation) << '\n';
    return failure;
  }
  std::cout << suggestion;
  return good;
}

const RadarConfiguration& ars408_named(const std::string& name,
                                       const Configuration& configuration) {
  const auto is_ars408 = [](const RadarConfiguration& radar) {
    return radar.decoder.as<Ars408Options>() != nullptr;
  };
  const auto& radars = configuration.radars;
  const auto found = std::ranges::find(radars, name, &RadarConfiguration::name);
  if (found == radars.end() || !is_ars408(*found)) {
    const std::string names = joined_if(radars, is_ars408, &RadarConfiguration::name);
    throw UsageError("'" + name + "' is not an ARS408 of the configuration, which has " +
                     (names.empty() ? "none" : names));
  }
  return *found;
}

std::vector<Ars408FilterState> filters_of(const Arguments& arguments) {
  std::vector<Ars408FilterState> filters;
  filters.reserve(arguments.filters.size());
  for (const std::string& text : arguments.filters) {
    const auto filter = parse_ars408_filter(text);
    if (!filter) {
      throw UsageError("--filter: '" + text + "' is not " + kArs408FilterWanted +
                       ", within what a frame can carry");
    }
    filters.push_back(*filter);
  }
  return filters;
}

/// Null if it is not up and open; prints the reason.
std::unique_ptr<CanSocket> socket_on(const std::string& interface) {
  Observation observation;
  observation.is_live = true;
  BusObservation bus;
  bus.interface = interface;
  std::unique_ptr<CanSocket> socket = open_bus({}, bus);
  if (bus.state == InterfaceState::up) {
    return socket;
  }
  print(bus_findings(bus, observation).front());
  return nullptr;
}

/// Searches for that radar only.
LocatedRadars locate_asked(const std::string& name, const Configuration& configuration) {
  if (!is_auto(ars408_named(name, configuration))) {
    return {configuration, {}};
  }
  const volatile std::sig_atomic_t stop = 0;  // A signal ends the program.
  LocatedRadars located = locate_live(configuration, &stop);
  std::erase_if(located.findings,
                [&](const Finding& finding) { return !finding.what.starts_with(name + ": "); });
  return located;
}

int run_talk(const Arguments& arguments) {
  const Configuration asked = load_configuration(configuration_path(arguments.config));
  const std::vector<Ars408FilterState> filters = filters_of(arguments);
  const std::string& name = arguments.ars408 + arguments.filtered;
  const LocatedRadars located = locate_asked(name, asked);
  std::ranges::for_each(located.findings, print);
  if (!located.findings.empty()) {
    return failure;
  }
  const Configuration& configuration = located.configuration;
  const RadarConfiguration& radar = ars408_named(name, configuration);
  const std::unique_ptr<CanSocket> socket = socket_on(radar.interface);
  if (socket == nullptr) {
    return failure;
  }
  const Ars408Talk talk{configuration, radar, arguments.talk, *socket, std::cout};
  const TalkResult result = arguments.ars408.empty() ? talk_about_filters(talk, filters)
                                                     : set_up_ars408(talk, arguments.setup);
  return result == TalkResult::took ? good : failure;
}

int run(CLI::App& app, int argc, char** argv) {
  Arguments arguments;
  app.footer(kFirstSteps);
  add_diagnosis_options(app, arguments);
  add_other_outputs(app, arguments);
  add_talk_options(app, arguments);
  app.parse(argc, argv);
  if (arguments.lcm_url && !is_lcm_url(*arguments.lcm_url)) {
    throw UsageError("--lcm-url: '" + *arguments.lcm_url + "' is not " + kLcmUrlWanted);
  }
  if (!is_talk(arguments) && (arguments.talk.address.said_id || arguments.talk.consent.is_given)) {
    throw UsageError("--sensor-id and --yes need --configure-ars408 or --ars408-filters");
  }
  if (!arguments.suggested_from.empty()) {
    return run_suggestion(arguments);
  }
  return is_talk(arguments) ? run_talk(arguments) : run_diagnosis(arguments);
}

}  // namespace

int main(int argc, char** argv) {
  return cremed::run_program("cremed-doctor",
                             "Explains missing odometry: one finding and its remedy per line", run,
                             argc, argv);
}
