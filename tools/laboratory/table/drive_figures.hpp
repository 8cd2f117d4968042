// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace cremed {

/// Some figures of a drive: those after a time over every window (trajectory_segments), truth's
/// noise not considered.
///
/// "1 s", "5 s", "10 s", "30 s": yaw RMS in degrees, position error in per cent of the path, ANEES;
/// "front alone": as "10 s", with the radar named "front" as the only one, if there is one;
/// "kellner", "submap", "submap_80": as "10 s", on the same windows (baselines).
///
/// With wheels:
/// "front", "rear": radars with such names from scan to scan: RMSE in metres and degrees, ANEES
/// with truth's noise;
/// "front by wheels", "outputs by wheels": NEES of x by the wheels and of yaw by the gyro, of those
/// radars from scan to scan and of the odometry from output to output.
using DriveFigures = std::map<std::string, std::vector<double>, std::less<>>;

/// Runs the odometry, and the methods of others, on a recorded drive: its folder has can.log or
/// can.log.xz, truth.csv and perhaps wheels.csv. Throws std::runtime_error.
DriveFigures drive_figures(const std::filesystem::path& folder,
                           const std::string& configuration_file);

/// Means of the figures that all drives have.
DriveFigures mean_figures(const std::vector<DriveFigures>& drives);

}  // namespace cremed
