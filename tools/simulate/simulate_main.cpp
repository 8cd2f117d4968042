// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <iomanip>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>

#include "daemon/command_line.hpp"
#include "daemon/configuration/configuration.hpp"
#include "daemon/configuration/interfaces.hpp"
#include "daemon/process/file_aliases.hpp"
#include "daemon/process/usage_error.hpp"
#include "tools/line_file.hpp"
#include "tools/program.hpp"
#include "tools/simulate/scenario.hpp"
#include "tools/simulate/simulation.hpp"

namespace {

using namespace cremed;

struct Arguments {
  std::string scenario;
  std::string output;
  std::string truth;
  std::string config;
  std::int64_t start_s = 1'700'000'000;
  bool is_not_told = false;
  SimulationOptions options;
};

void add_options(CLI::App& app, Arguments& arguments) {
  app.footer(
      "Examples:\n"
      "  Forty seconds of bends, and their odometry.\n"
      "    $ CONFIG=/usr/share/cremed/config/demo.toml\n"
      "    $ cremed-simulate --scenario bends --duration 40 --config $CONFIG --output bends.log\n"
      "    $ cremed --config $CONFIG --replay bends.log --output-odometry state.csv\n"
      "\n"
      "Files:\n"
      "  /usr/share/cremed/config/demo.toml  An ARS408 in front and a Bosch GPR at the rear");
  app.add_option("--scenario", arguments.scenario, "Drive to simulate; 'list' prints all")
      ->type_name("NAME")
      ->required();
  app.add_option("--output", arguments.output, "CAN frames as candump text; '-': standard output")
      ->type_name("FILE");
  app.add_option("--truth", arguments.truth, "True poses of the rear axle as CSV")
      ->type_name("FILE");
  app.add_option(
         "--config", arguments.config,
         "Configuration of cremed with the radars to simulate, and the vehicle bus if it has "
         "[vehicle]; default: an ARS408 in front on can0 and a Bosch GPR at the rear on "
         "can1")
      ->type_name("FILE");
  app.add_option("--seed", arguments.options.seed, "Same seed, same bytes")->capture_default_str();
  app.add_option("--duration", arguments.options.duration_s,
                 "Seconds to drive; default: the scenario's")
      ->check(number_in(0.5, 7200.0));
  app.add_option("--start", arguments.start_s, "Time of the start, seconds since the Unix epoch")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{4'000'000'000}))
      ->capture_default_str();
  const auto add_std = [&](const char* name, double& value, double max, const char* description) {
    app.add_option(name, value, std::string("Standard deviation ") + description)
        ->check(number_in(0.0, max))
        ->capture_default_str();
  };
  SimulationOptions& options = arguments.options;
  add_std("--body-velocity-std", options.body_velocity_std_mps, 5.0,
          "in m/s of the velocity of all radars relative to the rear axle while driving (pitch, "
          "suspension)");
  add_std("--doppler-offset-std", options.doppler_offset_std_mps, 5.0,
          "in m/s of an unreported offset of all Doppler of a radar while driving");
  add_std("--doppler-scale-std", options.doppler_scale_std, 0.1,
          "of the factor on all Doppler of a radar, drawn once per drive");
  add_std("--mount-yaw-std", options.mount_yaw_std_rad, 0.5,
          "in rad of a radar's yaw from the configured one, drawn once per drive");
  add_std("--mount-position-std", options.mount_position_std_m, 1.0,
          "in m of x and y of its mount, drawn once per drive");
  app.add_flag("--not-told", arguments.is_not_told,
               "ARS408s do not receive the vehicle's speed and yaw rate: they take static targets "
               "for moving, report radial velocities only and do not extrapolate positions");
}

void list_scenarios() {
  for (const Scenario& scenario : scenarios()) {
    std::cout << std::left << std::setw(12) << scenario.name << ' ' << scenario.description << " ("
              << scenario.duration_s << " s)\n";
  }
}

const Scenario& asked_scenario(const std::string& name) {
  if (const Scenario* scenario = find_scenario(name)) return *scenario;
  throw UsageError("--scenario: unknown scenario '" + name + "'; '--scenario list' prints all");
}

void write_truth(const Simulation& simulation, const std::string& path) {
  LineFile file(path);
  file.write(simulation.truth_csv());
  file.finish();
}

Configuration configuration_of(const std::string& path) {
  Configuration configuration;
  if (path.empty()) {
    configuration.radars = default_radars();
  } else {
    configuration = load_configuration(path);
    require_interface_names(configuration);
  }
  return configuration;
}

void simulate(Arguments& arguments) {
  const Scenario& scenario = asked_scenario(arguments.scenario);
  if (arguments.output.empty()) throw UsageError("--output is required, a file or '-'");
  const Configuration configuration = configuration_of(arguments.config);
  arguments.options.vehicle = configuration.vehicle;
  refuse_aliases({{"--config", arguments.config}},
                 {{"--output", arguments.output}, {"--truth", arguments.truth}});
  arguments.options.start_us = arguments.start_s * 1'000'000;
  arguments.options.is_told_motion = !arguments.is_not_told;
  Simulation simulation(scenario, configuration.radars, arguments.options);
  if (!arguments.truth.empty()) write_truth(simulation, arguments.truth);
  LineFile log(arguments.output);
  simulation.write_log(log);
  log.finish();
}

int run(CLI::App& app, int argc, char** argv) {
  Arguments arguments;
  add_options(app, arguments);
  app.parse(argc, argv);
  if (arguments.scenario == "list") {
    list_scenarios();
    return 0;
  }
  simulate(arguments);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return cremed::run_program("cremed-simulate",
                             "Simulates a drive as CAN frames of its radars, with truth", run, argc,
                             argv);
}
