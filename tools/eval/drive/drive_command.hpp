// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/eval/drive/truth_noise.hpp"
#include "tools/eval/drive/wheel_reference.hpp"

namespace cremed {

struct DriveFiles {
  std::string odometry;                ///< CSV that cremed wrote.
  std::string truth;                   ///< CSV: utime,x_m,y_m,yaw_rad.
  std::string wheels;                  ///< CSV: utime,speed_mps,yaw_rate_radps; empty: none.
  WheelStd wheels_std;                 ///< Error of the wheels.
  TruthNoise truth_noise;              ///< Error of truth.
  std::string plot;                    ///< Picture to draw; empty: none.
  std::string tables;                  ///< Folder for the plotted data as CSV; empty: none.
  std::string truth_tum;               ///< Truth to write in TUM format; empty: none.
  std::vector<std::string> baselines;  ///< candump logs for other methods; may be empty.
  std::vector<std::string> others;     ///< Trajectories of other systems; may be empty.
  std::string config;                  ///< Configuration for these logs.
  bool as_json = false;                ///< Prints JSON instead of tables.
};

/// The files that are written into DriveFiles::tables, in the order of plot_drive's arguments.
std::vector<std::string> table_paths(const std::string& folder);

/// cremed-eval drive: prints and draws the errors of a drive's odometry. Throws std::runtime_error.
void run_drive(const DriveFiles& files);

}  // namespace cremed
