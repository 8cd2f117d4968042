// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "daemon/process/file_aliases.hpp"
#include "daemon/process/usage_error.hpp"
#include "tools/eval/calibrate/calibrate_command.hpp"
#include "tools/eval/drive/drive_command.hpp"
#include "tools/eval/drive/drive_options.hpp"
#include "tools/program.hpp"

namespace {

/// Commands of another program, which needs what a vehicle has not.
constexpr const char* kLaboratory = "cremed-laboratory";

CLI::App* add_calibrate(CLI::App& app, cremed::CalibrateArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "calibrate", "Mounts, offsets and noise of the radars from a recorded drive, as TOML");
  command->add_option("LOG", arguments.logs, "Candump logs, merged by time")
      ->type_name("FILE")
      ->required();
  command->add_option("--config", arguments.config, "Configuration to start from")
      ->type_name("FILE")
      ->required();
  command
      ->add_option("--truth", arguments.truth,
                   "CSV: utime,x_m,y_m,yaw_rad; mounts are then in its frame")
      ->type_name("FILE");
  command->add_flag("--write", arguments.write,
                    "Also change the configuration, where the drive gives better values");
  command->footer(
      "Examples:\n"
      "  What a drive would change in a configuration; --write changes it.\n"
      "    $ cremed-eval calibrate candump.log --config my.toml > calibrated.toml");
  return command;
}

/// Commands that were not given have empty names.
void refuse_overwriting(const cremed::DriveFiles& drive,
                        const cremed::CalibrateArguments& calibrate) {
  std::vector<cremed::NamedFile> inputs = {
      {"ODOMETRY", drive.odometry}, {"TRUTH", drive.truth},         {"--wheels", drive.wheels},
      {"--config", drive.config},   {"--config", calibrate.config}, {"--truth", calibrate.truth}};
  for (const std::string& log : drive.baselines) {
    inputs.push_back({"--baselines", log});
  }
  for (const std::string& log : calibrate.logs) {
    inputs.push_back({"LOG", log});
  }
  std::vector<cremed::NamedFile> outputs = {{"--plot", drive.plot},
                                            {"--truth-tum", drive.truth_tum}};
  if (!drive.tables.empty()) {
    for (const std::string& table_path : cremed::table_paths(drive.tables)) {
      outputs.push_back({"--tables", table_path});
    }
  }
  cremed::refuse_aliases(inputs, outputs);
}

/// Runs the program beside this one, with the same arguments.
[[noreturn]] void hand_over(char** argv) {
  const auto here = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  ::execv((here / kLaboratory).c_str(), argv);
  throw cremed::UsageError(std::string(argv[1]) + " is a command of " + kLaboratory +
                           ", which is not installed: apt-get install " + kLaboratory);
}

int run(CLI::App& app, int argc, char** argv) {
  for (const char* command : {"table", "pairs"}) {
    if (argc > 1 && std::string_view(argv[1]) == command) {
      hand_over(argv);
    }
    app.add_subcommand(command, std::string("Of ") + kLaboratory + ": see its --help");
  }
  app.set_help_all_flag("--help-all", "Print the help of all subcommands and exit");
  app.require_subcommand(1);
  cremed::DriveFiles drive;
  cremed::CalibrateArguments calibrate;
  const CLI::App* calibrate_command = add_calibrate(app, calibrate);
  cremed::add_drive(app, drive);
  app.parse(argc, argv);
  refuse_overwriting(drive, calibrate);
  if (calibrate_command->parsed()) {
    cremed::run_calibrate(calibrate);
  } else {
    cremed::run_drive(drive);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return cremed::run_program(
      "cremed-eval", "Figures of cremed's credibility: RMSE, ANEES and coverage", run, argc, argv);
}
