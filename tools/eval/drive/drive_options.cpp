// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/drive_options.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "tools/eval/plot.hpp"

namespace cremed {
namespace {

/// Exactly `count` non-negative numbers separated by commas; CLI::ValidationError otherwise.
std::vector<double> numbers(const std::string& option, const std::string& text, std::size_t least,
                            std::size_t most) {
  std::vector<double> values;
  for (const std::string& cell : CLI::detail::split(text, ',')) {
    double value = 0.0;
    if (!CLI::detail::lexical_cast(cell, value) || !(value >= 0.0)) {
      throw CLI::ValidationError(option, "'" + cell + "' is not a number >= 0");
    }
    values.push_back(value);
  }
  if (values.size() < least || values.size() > most) {
    throw CLI::ValidationError(option, "'" + text + "' has the wrong number of values");
  }
  return values;
}

/// M,RAD or M,RAD,SECONDS or X_M,Y_M,RAD,SECONDS.
RelativePoseStd relative_pose_std(const std::string& text) {
  const auto values = numbers("--truth-std", text, 2, 4);
  if (values.size() == 4) {
    return {values[0], values[1], values[2], values[3]};
  }
  return {values[0], values[0], values[1], values.size() == 3 ? values[2] : 0.0};
}

/// Options of the second reference and of the accuracy of both.
void add_references(CLI::App& command, DriveFiles& files) {
  command
      .add_option("--wheels", files.wheels,
                  "CSV: utime,speed_mps,yaw_rate_radps; compares x and yaw with it and splits NEES "
                  "into the errors of the estimate and of truth")
      ->type_name("FILE");
  command
      .add_option_function<std::string>(
          "--wheels-std",
          [&](const std::string& text) {
            const auto values = numbers("--wheels-std", text, 2, 2);
            files.wheels_std = {values[0], values[1]};
          },
          "Standard deviations of the wheels' speed and yaw rate, constant over an interval "
          "(0,0)")
      ->type_name("MPS,RADPS");
}

}  // namespace

CLI::Option* add_truth_std(CLI::App& command, TruthNoise& noise) {
  return command
      .add_option_function<std::vector<std::string>>(
          "--truth-std",
          [&](const std::vector<std::string>& texts) {
            std::vector<RelativePoseStd> stds;
            std::transform(texts.begin(), texts.end(), std::back_inserter(stds), relative_pose_std);
            noise = TruthNoise(stds);
          },
          "Standard deviations of the relative pose of two of truth's stamps (x and y each, yaw), "
          "added to the covariances (0,0). If they depend on the time between the stamps, give "
          "them for several: M,RAD,SECONDS or X_M,Y_M,RAD,SECONDS")
      ->type_name("M,RAD")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_drive(CLI::App& app, DriveFiles& files) {
  CLI::App* command = app.add_subcommand("drive", "Compare the odometry of a drive with truth");
  command->footer(
      "Examples:\n"
      "  The vehicle's state in a recorded drive against truth, as tables and as a picture.\n"
      "    $ cremed --config my.toml --replay candump.log --output-odometry state.csv\n"
      "    $ cremed-eval drive state.csv truth.csv --plot drive.png");
  command
      ->add_option("ODOMETRY", files.odometry,
                   "CSV that cremed wrote: motions (--output-csv) or the vehicle's state "
                   "(--output-odometry)")
      ->type_name("FILE")
      ->required();
  command->add_option("TRUTH", files.truth, "CSV: utime,x_m,y_m,yaw_rad")
      ->type_name("FILE")
      ->required();
  add_references(*command, files);
  add_truth_std(*command, files.truth_noise);
  auto* logs = command->add_option("--baselines", files.baselines,
                                   "candump log of the drive, for other methods: Kellner's "
                                   "velocity by Doppler and a submap of scans matched by NDT "
                                   "(Kung et al.); may repeat");
  auto* config = command->add_option("--config", files.config, "Configuration of its radars")
                     ->type_name("FILE");
  logs->type_name("FILE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->needs(config);
  config->needs(logs);
  command
      ->add_option("--other", files.others,
                   "Trajectory of another system to compare: FILE in TUM format (x forward, y "
                   "left), or FILE,TIMES in KITTI's (a camera's axes), of the rear axle's centre; "
                   "may repeat")
      ->type_name("FILE[,TIMES]")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_flag("--json", files.as_json, "Print one JSON object instead of the tables");
  command
      ->add_option("--plot", files.plot,
                   "Draw trajectories, drift, errors and NEES of each source (PNG, SVG)")
      ->type_name("FILE")
      ->check(picture_problem);
  command
      ->add_option("--tables", files.tables,
                   "Write what --plot draws as CSV files into this folder")
      ->type_name("FOLDER");
  command
      ->add_option("--truth-tum", files.truth_tum,
                   "Write truth at the times of the estimates in TUM format, for evo")
      ->type_name("FILE");
}

}  // namespace cremed
