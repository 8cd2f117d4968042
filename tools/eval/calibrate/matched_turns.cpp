// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/calibrate/matched_turns.hpp"

#include <cmath>
#include <cstdint>
#include <optional>

#include <Eigen/Geometry>

#include "tools/eval/calibrate/matched_targets.hpp"
#include "tools/eval/drive/true_trajectory.hpp"

namespace cremed {
namespace {

/// Scans between two that are compared: 0.3 to 0.4 s. A target's motion is then larger than its
/// noise, and most are still seen. Every moment is measured this many times: standard deviations
/// are those of one.
constexpr std::size_t kLag = 5;
constexpr double kLongestS = 0.5;  // Between two scans, for one step of the motion.
constexpr double kGate = 3.0;      // Standard deviations of an azimuth; beyond it, another target.
constexpr std::size_t kMinMatches = 3;

std::vector<RecordedScan> static_parts(const std::vector<RecordedScan>& scans,
                                       const CalibrationFit& fit, std::size_t radar) {
  std::vector<RecordedScan> result;
  for (const RecordedScan& scan : scans) {
    const auto expected = fit.expected(radar, scan.stamp_us);
    result.push_back(expected ? static_part(scan, *expected)
                              : RecordedScan{scan.stamp_us, {}, 0.0});
  }
  return result;
}

/// From the scan kLag before the `last` one.
std::optional<Pose2> motion_to(const std::vector<RecordedScan>& scans, const CalibrationFit& fit,
                               std::size_t radar, std::size_t last) {
  Pose2 motion;
  for (std::size_t i = last - kLag; i < last; ++i) {
    const auto step = radar_motion(fit, radar, scans[i].stamp_us, scans[i + 1].stamp_us);
    if (!step) {
      return std::nullopt;
    }
    motion = moved(motion, {step->x_m, step->y_m, step->yaw_rad});
  }
  return motion;
}

/// Mean azimuth by which targets are left of their places, and its information.
struct MeanError {
  double rad = 0.0;
  double information = 0.0;
};

std::optional<MeanError> mean_error(const MatchErrors& errors) {
  double sum = 0.0;
  MeanError mean;
  std::size_t count = 0;
  for (std::size_t i = 0; i < errors.azimuth.size(); ++i) {
    if (std::abs(errors.azimuth[i].error) < kGate) {
      sum += errors.azimuth[i].error / errors.azimuth_std_rad[i];
      mean.information += 1.0 / (errors.azimuth_std_rad[i] * errors.azimuth_std_rad[i]);
      ++count;
    }
  }
  mean.rad = sum / mean.information;
  return count < kMinMatches ? std::nullopt : std::optional(mean);
}

}  // namespace

std::optional<Pose2> radar_motion(const CalibrationFit& fit, std::size_t radar,
                                  std::int64_t begin_us, std::int64_t end_us) {
  const double dt_s = static_cast<double>(end_us - begin_us) * 1e-6;
  const std::int64_t middle_us = begin_us + (end_us - begin_us) / 2;
  const auto state = fit.expected(radar, middle_us);
  const auto vehicle = fit.motion(radar, middle_us);
  if (!state || !vehicle || dt_s > kLongestS) {
    return std::nullopt;
  }
  const double yaw_rad = vehicle->y() * dt_s;
  const Eigen::Vector2d way =
      Eigen::Rotation2Dd(0.5 * yaw_rad) * Eigen::Vector2d(state->head<2>()) * dt_s;
  return Pose2{way.x(), way.y(), yaw_rad};
}

std::vector<YawRateMeasurement> matched_turns(const std::vector<RecordedScan>& scans,
                                              const CalibrationFit& fit, std::size_t radar,
                                              double azimuth_std_factor) {
  const std::vector<RecordedScan> fixed = static_parts(scans, fit, radar);
  const double lead_s = fit.radars()[radar].value[kPositionLead];
  std::vector<YawRateMeasurement> result;
  for (std::size_t i = kLag; i < fixed.size(); ++i) {
    const std::int64_t begin_us = fixed[i - kLag].stamp_us;
    const double dt_s = static_cast<double>(fixed[i].stamp_us - begin_us) * 1e-6;
    const std::int64_t middle_us = begin_us + std::llround(dt_s * 0.5e6);
    const auto motion = motion_to(fixed, fit, radar, i);
    const auto vehicle = fit.motion(radar, middle_us, lead_s);
    if (!motion || !vehicle) {
      continue;
    }
    MatchErrors errors;
    add_match_errors(fixed[i - kLag], fixed[i], *motion, {1.0, azimuth_std_factor}, errors);
    if (const auto error = mean_error(errors)) {
      result.push_back({radar, kMatchedTurn, middle_us, vehicle->y() - error->rad / dt_s,
                        std::sqrt(kLag / error->information) / dt_s});
    }
  }
  return result;
}

}  // namespace cremed
