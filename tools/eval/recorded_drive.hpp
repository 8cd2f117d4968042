// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "cremed/estimator/motion/ego_motion_estimator.hpp"
#include "cremed/estimator/scan/target_set.hpp"
#include "daemon/configuration/configuration.hpp"
#include "daemon/output/odometry_sink.hpp"

namespace cremed {

/// The targets of one scan that an estimate would use, in the radar's frame: their bearing is the
/// azimuth.
struct RecordedScan {
  std::int64_t stamp_us = 0;
  std::vector<Target> targets;
  /// The vehicle's yaw rate as the sensor receives it (estimator/scan/rotation_lead.hpp); 0: it
  /// receives none.
  double told_yaw_rate_radps = 0.0;
};

/// The pipeline's results for one radar.
struct RecordedRadar {
  std::vector<RecordedScan> scans;   ///< Complete ones.
  std::vector<EgoMotion> motions;    ///< Estimates only.
  std::size_t without_estimate = 0;  ///< Motions since another scan that are none.
};

/// The pipeline's results.
struct PlayedDrive {
  std::vector<RecordedRadar> radars;  ///< One per radar of the configuration.
  std::vector<Odometry> outputs;      ///< Of the odometry.
  std::vector<EgoMotion> fused;       ///< From output to output; estimates only.
};

/// Runs recorded drives through the pipeline; another sink, unless null, receives the same. Throws
/// std::runtime_error if a log cannot be read.
PlayedDrive play_drive(const Configuration& configuration, const std::vector<std::string>& logs,
                       OdometrySink* other = nullptr);

/// The same; throws std::runtime_error also if no radar sent a scan.
PlayedDrive record_drive(const Configuration& configuration, const std::vector<std::string>& logs);

}  // namespace cremed
