// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "can_decoders/can_frame.hpp"
#include "daemon/configuration.hpp"
#include "daemon/frame_source.hpp"
#include "daemon/odometry_sink.hpp"
#include "daemon/radar_channel.hpp"

namespace cremed {

/// Time in microseconds, for measuring how long an estimate takes.
using NowFunction = std::int64_t (*)();

/// The whole way from a frame to a message:
///
///     FrameSource -> RadarDecoder -> ScanAssembler -> EgoMotionEstimator -> OdometrySink
///
/// Time is that of the frames' stamps; nothing here reads a clock but `now`, whose differences are
/// reported as solve_us. After construction nothing allocates, locks or logs.
class Pipeline {
 public:
  /// `source` (for its counters) and `sinks` must outlive the pipeline.
  Pipeline(const Configuration& configuration, const FrameSource& source,
           std::vector<OdometrySink*> sinks, NowFunction now);

  void on_frame(const CanFrame& frame);
  /// Frames were lost on an interface: scans open on it cannot be whole.
  void on_dropped(std::uint8_t interface);
  /// No more frames: closes open scans and reports a last status.
  void finish();

  [[nodiscard]] const std::vector<std::unique_ptr<RadarChannel>>& radars() const { return radars_; }

 private:
  void on_time(std::int64_t now_us);
  void publish_motions(RadarChannel& radar);
  void publish_status();

  const FrameSource& source_;
  std::vector<OdometrySink*> sinks_;
  NowFunction now_;
  std::vector<std::unique_ptr<RadarChannel>> radars_;
  std::optional<std::int64_t> time_us_;  // Of the last frame; none yet.
  std::int64_t next_status_us_ = 0;
};

}  // namespace cremed
