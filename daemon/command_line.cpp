// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/command_line.hpp"

#include <algorithm>

#include <CLI/CLI.hpp>

#include "cremed/version.hpp"
#include "daemon/configuration/first_configuration.hpp"
#include "daemon/configuration/lcm_url.hpp"

namespace cremed {
namespace {

constexpr int kBadUsage = 2;

/// "max" or a factor > 0; throws CLI::ValidationError.
double parse_speed(const std::string& text) {
  if (text == "max") {
    return 0.0;
  }
  double factor = 0.0;
  if (!CLI::detail::lexical_cast(text, factor) || !(factor > 0.0) || factor > 1e6) {
    throw CLI::ValidationError("--speed", "'" + text + "' is neither max nor a factor > 0");
  }
  return factor;
}

void check(const CommandLine& c) {
  const long standard_inputs = std::ranges::count(c.replay, "-");
  if (standard_inputs > 1) {
    throw CLI::ValidationError("--replay", "standard input (-) can be read only once");
  }
  if (c.check_config && !c.check_config->empty() && !c.config.empty()) {
    throw CLI::ValidationError("--check-config", "name the file once, here or as --config");
  }
  if (c.lcm_url && !is_lcm_url(*c.lcm_url)) {
    throw CLI::ValidationError("--lcm-url", "'" + *c.lcm_url + "' is not " + kLcmUrlWanted);
  }
}

}  // namespace

CommandLineResult parse_command_line(int argc, const char* const* argv) {
  CommandLine c;
  std::string speed = "max";
  CLI::App app{
      "Radar ego-motion with credible covariance\n"
      "Without --replay it runs on the CAN interfaces of the configuration.",
      "cremed"};
  app.footer(kFirstSteps);
  app.set_version_flag("--version", "cremed " CREMED_VERSION);
  app.add_option("--config", c.config, "Configuration (default: /etc/cremed/cremed.toml)")
      ->type_name("FILE");
  std::string checked;
  const auto* check_config =
      app.add_option("--check-config", checked,
                     "Check a configuration (default: that of --config), show it as read, and exit")
          ->expected(0, 1)
          ->type_name("[FILE]");
  app.add_option("--replay", c.replay, "candump log to replay, - for standard input; may repeat")
      ->type_name("FILE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--speed", speed, "Speed of the replay: max, or a factor of real time")
      ->type_name("FACTOR")
      ->capture_default_str();
  app.add_option("--state-file", c.state_file,
                 "File of the learned errors: read at the start, written at the end; live it "
                 "overrides odometry.state_file, which a replay does not use")
      ->type_name("FILE");
  app.add_option("--output-csv", c.output_csv, "Write ego-motions as CSV; - for standard output")
      ->type_name("FILE");
  app.add_option("--output-odometry", c.output_odometry, "Write the vehicle's state as CSV")
      ->type_name("FILE");
  app.add_option("--output-tum", c.output_tum, "Write the trajectory in TUM format")
      ->type_name("FILE");
  app.add_option("--lcm-url", c.lcm_url,
                 "LCM URL, or none; overrides the configuration. A replay publishes only with it")
      ->type_name("URL");
  app.add_flag("--publish-scans", c.publish_scans,
               "Publish each scan too, as output.publish_scans = true does");
  app.add_flag("--timing", c.timing,
               "Measure solve_us in a replay (output is then no longer byte-identical)");
  try {
    app.parse(argc, argv);
    c.speed = parse_speed(speed);
    c.check_config = check_config->count() != 0 ? std::optional(checked) : std::nullopt;
    check(c);
  } catch (const CLI::ParseError& error) {
    return {std::nullopt, app.exit(error) == 0 ? 0 : kBadUsage};
  }
  return {c, 0};
}

Configuration load_configuration(const std::string& path, const CommandLine& command_line) {
  Configuration configuration = load_configuration(path);
  OutputConfiguration& output = configuration.output;
  output.publish_scans |= command_line.publish_scans;
  output.csv = command_line.output_csv.value_or(output.csv);
  output.odometry = command_line.output_odometry.value_or(output.odometry);
  output.tum = command_line.output_tum.value_or(output.tum);
  return configuration;
}

}  // namespace cremed
