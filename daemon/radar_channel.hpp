// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "cremed/can_decoders/radar_decoder.hpp"
#include "cremed/can_decoders/scan_assembler.hpp"
#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/motion/ego_motion_estimator.hpp"
#include "cremed/estimator/motion/self_check.hpp"
#include "daemon/configuration/configuration.hpp"
#include "daemon/output/radar_status.hpp"
#include "daemon/report/latency_histogram.hpp"
#include "daemon/source/frame_source.hpp"

namespace cremed {

/// One radar's stages. Neither copied nor moved: the assembler refers to the decoder.
struct RadarChannel {
  RadarChannel(const RadarConfiguration& configuration, std::size_t radar_index,
               std::uint8_t interface_index);
  RadarChannel(const RadarChannel&) = delete;
  RadarChannel& operator=(const RadarChannel&) = delete;

  /// Notes an estimate in the status.
  void count(const EgoMotion& motion);
  /// Notes whether a scan went into the odometry.
  void count(const Odometry& odometry);
  /// Notes in the status what the odometry filter knows of it.
  void note_report(const RadarReport& report);
  /// Notes how long a scan took from its last frame to the end of its publication, and how much of
  /// that its registration took.
  void note_duration(std::int64_t latency_us, std::int64_t solve_us);
  /// Sums up the latencies since the last call: the status shows them until the next.
  void begin_period();
  /// The status with all stages' counters as of now.
  const RadarStatus& status(std::int64_t utime_us, const FrameSource& source);

  std::size_t index;
  std::uint8_t interface;
  /// Bit i: its frames and those of interface i are stamped by clocks that agree, as far as known.
  std::uint32_t shares_clock = 0;
  std::unique_ptr<RadarDecoder> decoder;
  ScanAssembler assembler;
  EgoMotionEstimator estimator;
  SelfCheck self_check;
  /// Stamp of its last scan while the odometry still has to take it.
  std::optional<std::int64_t> held_us;
  LatencyHistogram latencies;    ///< Since the start.
  LatencyHistogram solve_times;  ///< Since the start.

 private:
  LatencyHistogram latency_;  // Since begin_period().
  RadarStatus status_;
};

}  // namespace cremed
