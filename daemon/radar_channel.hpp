// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "cremed/can_decoders/radar_decoder.hpp"
#include "cremed/can_decoders/scan_assembler.hpp"
#include "cremed/estimator/doubt/radar/self_check.hpp"
#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/motion/ego_motion_estimator.hpp"
#include "daemon/bus_clocks.hpp"
#include "daemon/configuration/configuration.hpp"
#include "daemon/output/radar_status.hpp"
#include "daemon/report/latency_histogram.hpp"
#include "daemon/source/frame_source.hpp"

namespace cremed {

/// One radar's stages. Not copyable: the assembler refers to the decoder.
struct RadarChannel {
  RadarChannel(const RadarConfiguration& configuration, std::size_t radar_index,
               std::uint8_t interface_index);
  RadarChannel(const RadarChannel&) = delete;
  RadarChannel& operator=(const RadarChannel&) = delete;

  /// Multiplies the Doppler of all scans from now on by a factor that was learned; its own check
  /// begins anew.
  void correct_doppler(double factor);
  /// Counts an estimate in the status.
  void count(const EgoMotion& motion);
  /// Counts whether a scan was used by the odometry.
  void count(const Odometry& odometry);
  /// Copies the odometry filter's report into the status.
  void note_report(const RadarReport& report);
  /// Notes the time from a scan's last frame to the end of its publication.
  void note_latency(std::int64_t latency_us) { latency_.add(latency_us); }
  /// Takes the latencies since the last call into the status.
  void begin_period();
  /// The status with the present counters of all stages.
  const RadarStatus& status(std::int64_t utime_us, const FrameSource& source);

  std::size_t index;
  std::uint8_t interface;
  std::unique_ptr<RadarDecoder> decoder;
  ScanAssembler assembler;
  EgoMotionEstimator estimator;
  SelfCheck self_check;
  ScanClock scan_clock;
  bool is_ahead = false;   ///< Its stamps are ahead of those of all other buses (BusClocks).
  bool is_behind = false;  ///< Its stamps are behind those of all other buses.

 private:
  double doppler_factor_ = 1.0;  // Learned in all.
  LatencyHistogram latency_;     // Since begin_period().
  RadarStatus status_;
};

}  // namespace cremed
