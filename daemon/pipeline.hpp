// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "cremed/can_decoders/can_frame.hpp"
#include "daemon/bus_clocks.hpp"
#include "daemon/configuration/configuration.hpp"
#include "daemon/odometry_stage.hpp"
#include "daemon/output/odometry_sink.hpp"
#include "daemon/output/outputs.hpp"
#include "daemon/radar_channel.hpp"
#include "daemon/report/status_timer.hpp"
#include "daemon/report/vehicle_findings.hpp"
#include "daemon/source/frame_source.hpp"
#include "daemon/vehicle_listener.hpp"

namespace cremed {

/// Steps forward of the clock of the stamps, by the radars' cycle counters.
struct ForwardSteps {
  std::uint64_t count = 0;
  double longest_s = 0.0;
  ForwardStep last;
};

/// The whole path from a frame to a message:
///
///     FrameSource -> RadarDecoder -> ScanAssembler -> EgoMotionEstimator -> OdometrySink
///                                                          |                    |
///                                           of all radars  +-> OdometryStage ---+
///
/// (daemon/README.md: where frames and scans are put in order, and MotionFeedback, a sink that
/// sends on the bus.)
///
/// With [vehicle], the odometry also gets the speed and yaw rate of the vehicle's bus, and uses at
/// a scan what was measured before it.
///
/// Time is that of the stamps; `clock` is for durations (solve_us, latency) and, live, for what is
/// too old to be sent (Outputs). Frames in the order of their stamps therefore give the same
/// results live and in a replay. After construction nothing allocates, locks or logs.
class Pipeline {
 public:
  /// `source` (for its counters) and `sinks` must outlive the pipeline. `learned`: errors learned
  /// in an earlier drive, by radar; may be empty.
  Pipeline(const Configuration& configuration, const FrameSource& source,
           std::vector<OdometrySink*> sinks, PipelineClock clock,
           const std::vector<std::optional<LearnedErrors>>& learned = {});
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  /// Processes the source's next event; false at its end. The loop of the daemon.
  bool take_next(FrameSource& source);
  /// An event of a source, with the `frame` it has set.
  void on_event(SourceEvent event, const CanFrame& frame);

  void on_frame(const CanFrame& frame);
  /// Frames were lost on an interface: its open scans become incomplete.
  void on_dropped(std::uint8_t interface);
  /// The clock of the stamps was set: open scans close, and no motion spans the step.
  void on_clock_step();
  /// Nothing to read. `now_us` is of the clock of the stamps.
  void on_idle(std::int64_t now_us);
  /// End of input: closes open scans and reports a last status.
  void finish();

  /// Least number of frames until a scan can be complete; 0 if no scan is open.
  [[nodiscard]] std::size_t frames_to_next_scan() const;

  /// Moves the radar to this interface.
  void set_interface(std::size_t radar, std::uint8_t interface) {
    radars_[radar]->interface = interface;
  }

  [[nodiscard]] const std::vector<std::unique_ptr<RadarChannel>>& radars() const { return radars_; }
  /// Results that were older than live.max_latency_s by the clock of the stamps, and not sent.
  [[nodiscard]] std::uint64_t stale_results() const { return outputs_.failures(); }
  /// The learned errors, by radar, for the next start; empty unless the odometry is ok or
  /// standing_still. Not for the hot path.
  [[nodiscard]] std::vector<std::optional<LearnedErrors>> learned() const;
  [[nodiscard]] const ForwardSteps& forward_steps() const { return forward_steps_; }
  /// State of a signal of [vehicle].
  [[nodiscard]] VehicleStatus vehicle(VehicleSignal signal) const;
  /// The odometry of the last scan; nothing before the first.
  [[nodiscard]] const std::optional<Odometry>& odometry() const { return odometry_.odometry(); }

 private:
  /// `clock`: the interface of the frame, or StatusTimer::kNoInterface.
  void on_time(std::size_t clock, std::int64_t now_us);
  /// Closes the overdue scans at the time of a frame of `interface`, or of silence on all buses.
  void close_overdue(std::int64_t now_us, std::optional<std::uint8_t> interface = std::nullopt);
  template <typename Condition>
  RadarChannel* first_to_close(Condition condition);
  void use_scans(RadarChannel& radar, std::int64_t begin_us);
  void use(RadarChannel& radar, const RadarScan& scan, std::int64_t begin_us);
  void check(RadarChannel& radar, EgoMotion& motion);
  void hold(RadarChannel& radar, const EgoMotion& motion);
  void count(const ForwardStep& step);
  void forget_motions();
  void publish_status();

  const FrameSource& source_;
  PipelineClock clock_;
  Outputs outputs_;
  std::vector<std::unique_ptr<RadarChannel>> radars_;
  VehicleListener vehicle_;
  BusClocks clocks_;
  ForwardSteps forward_steps_;
  OdometryStage odometry_;
  std::optional<std::int64_t> time_us_;  // Of the last event with a time.
  StatusTimer status_timer_;
};

}  // namespace cremed
