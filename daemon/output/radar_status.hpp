// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "cremed/can_decoders/radar_decoder.hpp"
#include "cremed/can_decoders/radar_health.hpp"
#include "cremed/can_decoders/scan_assembler.hpp"
#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/motion/ego_motion_estimator.hpp"
#include "daemon/source/frame_source.hpp"

namespace cremed {

/// Quantiles since the last status.
struct LatencySummary {
  std::uint64_t scans = 0;
  std::int64_t p50_us = 0;
  std::int64_t p99_us = 0;
  std::int64_t max_us = 0;
};

/// Whether a radar's covariance is credible, by SelfCheck and the odometry filter. Time-averaged
/// NIS over the last minute: 1 expected, 0 none yet.
struct BeliefStatus {
  double doppler_nis = 0.0;  ///< Doppler predicted from positions.
  double next_nis = 0.0;     ///< Each motion predicted from the one before.
  std::uint32_t doubts = 0;  ///< Doubt bits; 0: no doubt.
  /// Positions gave a speed in the last seconds, which the Doppler check needs.
  bool is_speed_checked = false;
  /// By which the Doppler would have to be multiplied, if its scale is wrong (DopplerScale).
  std::optional<double> doppler_correction = std::nullopt;
};

/// All counters of one radar's pipeline.
struct RadarStatus {
  std::int64_t utime_us = 0;
  MotionStatus last_motion_status = MotionStatus::no_reference;
  std::int64_t utime_last_estimate_us = 0;  ///< 0: none yet.
  SourceCounters source;
  BusStatus bus;
  RadarHealth health;
  LatencySummary latency;
  BeliefStatus belief;
  RadarReport odometry;
  std::uint64_t scans_in_odometry = 0;
  DecoderCounters decoder;
  AssemblerCounters assembler;
  SelectionCounters selection;
  std::array<std::uint64_t, kMotionStatusCount> motions_by_status{};
  std::uint64_t motions_of_incomplete_scans = 0;  ///< Estimates from incomplete scans.
};

}  // namespace cremed
