// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <csignal>
#include <cstring>
#include <exception>
#include <iostream>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>
#include <net/if.h>

#include "daemon/command_line.hpp"
#include "daemon/configuration.hpp"
#include "daemon/configuration_path.hpp"
#include "daemon/multicast_route.hpp"
#include "daemon/process_setup.hpp"
#include "daemon/signals.hpp"
#include "tools/doctor/ars408_setup.hpp"
#include "tools/doctor/bus_findings.hpp"
#include "tools/doctor/can_interfaces.hpp"
#include "tools/doctor/diagnosis.hpp"
#include "tools/doctor/live_observation.hpp"
#include "tools/doctor/log_observation.hpp"

namespace {

using namespace cremed;

enum ExitStatus : int { good = 0, failure = 1, bad_usage = 2 };

struct Arguments {
  std::string config;
  double seconds = 3.0;
  std::string replay;
  std::optional<std::string> lcm_url;
  std::string ars408;
  Ars408Setup setup;
};

void add_diagnosis_options(CLI::App& app, Arguments& arguments) {
  app.add_option("--config", arguments.config,
                 "Configuration (default: /etc/cremed/cremed.toml, then the installed one)");
  app.add_option("--seconds", arguments.seconds, "How long to listen")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  app.add_option("--replay", arguments.replay,
                 "Diagnose a candump log instead of the live bus; - for standard input");
  app.add_option("--lcm-url", arguments.lcm_url,
                 "LCM URL to check, or none; overrides the configuration. A log is diagnosed "
                 "without LCM unless it is given");
}

void add_setup_options(CLI::App& app, Arguments& arguments) {
  auto* configure = app.add_option("--configure-ars408", arguments.ars408,
                                   "Set the sensor of this radar to what the configuration "
                                   "expects; asks before it sends");
  configure->excludes("--replay");
  app.add_option("--max-distance", arguments.setup.max_distance_m,
                 "Set its range in m too (by model 196 to 260, or up to 1200)")
      ->check(CLI::Range(196.0, 1200.0))
      ->needs(configure);
  app.add_flag("--store", arguments.setup.store,
               "Write its settings to its flash, so that they outlast power-off")
      ->needs(configure);
  app.add_flag("--yes", arguments.setup.is_agreed, "Do not ask")->needs(configure);
}

void print(const Finding& finding) {
  const char* severity = finding.severity == Severity::error     ? "error: "
                         : finding.severity == Severity::warning ? "warning: "
                                                                 : "note: ";
  std::cout << severity << to_text(finding) << '\n';
}

Observation observe(const Arguments& arguments, const Configuration& configuration,
                    const volatile std::sig_atomic_t* stop) {
  Observation observation = arguments.replay.empty()
                                ? observe_live(configuration, arguments.seconds, stop)
                                : observe_log(configuration, arguments.replay);
  const bool asks_for_lcm = arguments.replay.empty() || arguments.lcm_url;
  if (asks_for_lcm) {
    observation.lcm_problem =
        multicast_problem(arguments.lcm_url.value_or(configuration.output.lcm_url));
  }
  return observation;
}

int run_diagnosis(const Arguments& arguments, const Configuration& configuration) {
  // Live, a signal ends the listening; of a log it ends the doctor.
  const Observation observation =
      observe(arguments, configuration, arguments.replay.empty() ? handle_stop_signals() : nullptr);
  const std::vector<Finding> findings = diagnose(configuration, observation);
  std::for_each(findings.begin(), findings.end(), print);
  const bool is_well = std::all_of(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.severity == Severity::note;
  });
  for (std::size_t i = 0; i < configuration.radars.size(); ++i) {
    std::cout << (is_well ? "no finding: " : "")
              << vital_signs(configuration.radars[i], observation.radars[i], observation.seconds)
              << '\n';
  }
  return is_well ? good : failure;
}

const RadarConfiguration& ars408_named(const std::string& name,
                                       const Configuration& configuration) {
  std::string names;
  for (const RadarConfiguration& radar : configuration.radars) {
    if (std::holds_alternative<Ars408Options>(radar.decoder)) {
      if (radar.name == name) {
        return radar;
      }
      names += (names.empty() ? "" : ", ") + radar.name;
    }
  }
  throw UsageError("--configure-ars408: '" + name + "' is no ARS408 of the configuration; it has " +
                   (names.empty() ? "none" : names));
}

/// Opens the interface, or says why that cannot be.
bool open_bus(const std::string& interface, CanSocket& socket) {
  Observation observation;
  observation.is_live = true;
  BusObservation bus;
  bus.interface = interface;
  bus.state = state_of(interface);
  if (bus.state == InterfaceState::up) {
    const CanOpenResult result = socket.open(::if_nametoindex(interface.c_str()), {}, {});
    if (result.status == CanOpenStatus::open) {
      return true;
    }
    bus.state = InterfaceState::failed;
    bus.error = std::strerror(result.error);
  }
  print(bus_findings(bus, observation).front());
  return false;
}

int run_setup(const Arguments& arguments, const Configuration& configuration) {
  const RadarConfiguration& radar = ars408_named(arguments.ars408, configuration);
  CanSocket socket;
  if (!open_bus(radar.interface, socket)) {
    return failure;
  }
  const SetupResult result =
      set_up_ars408(configuration, radar, arguments.setup, socket, std::cin, std::cout);
  return result == SetupResult::took ? good : failure;
}

int run(int argc, char** argv) {
  CLI::App app{"Explains why there is no odometry: one finding a line, with what mends it"};
  Arguments arguments;
  add_diagnosis_options(app, arguments);
  add_setup_options(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? good : bad_usage;
  }
  if (arguments.lcm_url && !is_lcm_url(*arguments.lcm_url)) {
    throw UsageError("--lcm-url: '" + *arguments.lcm_url + "' is not " + kLcmUrlWanted);
  }
  const Configuration configuration = load_configuration(configuration_path(arguments.config));
  return arguments.ars408.empty() ? run_diagnosis(arguments, configuration)
                                  : run_setup(arguments, configuration);
}

}  // namespace

int main(int argc, char** argv) {
  cremed::set_up_process();
  try {
    return cremed::finish_process(run(argc, argv));
  } catch (const UsageError& error) {
    std::cerr << "cremed-doctor: " << error.what() << '\n';
    return bad_usage;
  } catch (const ConfigurationError& error) {
    std::cerr << "cremed-doctor: " << error.what() << '\n';
    return bad_usage;
  } catch (const std::exception& error) {
    std::cerr << "cremed-doctor: " << error.what() << '\n';
    return failure;
  }
}
