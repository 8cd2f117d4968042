// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "daemon/configuration/configuration.hpp"
#include "tools/eval/calibrate/calibration_fit.hpp"
#include "tools/eval/calibrate/held_out_check.hpp"
#include "tools/eval/calibrate/sensor_noise.hpp"
#include "tools/eval/drive/true_trajectory.hpp"

namespace cremed {

/// Result of a recorded drive for one radar. Offset, stamp and factors are relative to the
/// configured ones.
struct RadarCalibration {
  FittedRadar free;  ///< With all states unknown.
  FittedRadar fit;   ///< With the configured value held where it is not improved.
  /// false: the configured value was kept.
  std::array<bool, kCalibrationStates> is_changed{};
  SensorNoise noise;
  std::size_t scans = 0;
  std::size_t explained_scans = 0;  ///< While driving, by the motion of all radars.
  bool is_refused = false;          ///< What was found fits other parts of the drive no better.
  /// Yaw of the fit's prior minus the configured one, if by that the radar did not move ahead as
  /// the others; it is then changed in any case.
  double turned_rad = 0.0;
};

struct Calibration {
  std::vector<RadarCalibration> radars;
  FittedVehicle vehicle{};
  bool is_slip_changed = false;  ///< false: the configured one was kept.
  bool is_slip_refused = false;  ///< What was found fits other parts of the drive no better.
  bool has_truth = false;
  std::optional<HeldOutCheck> check{};  ///< Of what was found; nothing if that was nothing.
};

/// Errors that do not average over one drive: standard deviations, added to what the drive's blocks
/// of time differ by.
struct SystematicErrors {
  /// Azimuth scale by Doppler: scatter of one radar between five nuScenes drives.
  double doppler_azimuth = 0.005;
  /// Doppler offset, m/s: RMS of what is found without truth for the front radar on five nuScenes
  /// drives (-0.13 to -0.24; rear ones -0.01 to 0.24), from mounts that were only estimated. The
  /// cause is unknown; the odometry is worse with it.
  double doppler_offset = 0.17;
  /// Turned angle of targets over the true one, without a known cause: 0.5 to 1 % of two tight
  /// turns of nuScenes, and what makes the lever arms of simulated drives credible.
  double turn = 0.015;
  /// Slip per lateral acceleration, rad s^2/m: half the difference of two RadarScenes drives.
  double slip = 0.0006;
};

/// Calibrates all radars of the configuration together. With `truth`, mounts are in its frame and
/// the rolling direction is estimated. If `truth` is null, only mounts against the rolling
/// direction are observable; what they turn by in common is shared between both by how well they
/// are known: each configured yaw to mount_yaw_std_rad, the direction to odometry.slip_std_rad. y,
/// stamps and scale are then relative to the first radar's. Throws std::runtime_error.
Calibration calibrate(const Configuration& configuration, const std::vector<std::string>& logs,
                      const TrueTrajectory* truth, const SystematicErrors& errors = {});

/// The value of the configuration's key (mount, calibration) that a state stands for, if the fit
/// found `found`. The lead from registrations has none: the value it would give rotation_lead_s.
double key_value(const RadarConfiguration& configured, CalibrationState state, double found);

/// The configuration with the results.
Configuration calibrated(const Configuration& configuration, const Calibration& calibration);

}  // namespace cremed
