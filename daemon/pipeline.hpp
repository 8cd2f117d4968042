// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "cremed/can_decoders/can_frame.hpp"
#include "cremed/estimator/fusion/odometry_filter.hpp"
#include "daemon/bus_clocks.hpp"
#include "daemon/configuration/configuration.hpp"
#include "daemon/output/odometry_sink.hpp"
#include "daemon/radar_channel.hpp"
#include "daemon/report/status_timer.hpp"
#include "daemon/report/vehicle_findings.hpp"
#include "daemon/source/frame_source.hpp"
#include "daemon/vehicle_listener.hpp"

namespace cremed {

/// Clock for durations.
struct PipelineClock {
  std::int64_t (*now_us)();
  /// true: `now_us` is the clock of the stamps, and latency counts from the stamp of a scan's last
  /// frame; false: from the call of on_frame().
  bool is_stamp_clock = false;
};

/// The whole path from a frame to a message:
///
///     FrameSource -> RadarDecoder -> ScanAssembler -> EgoMotionEstimator -> OdometrySink
///                                                          |                    |
///                                           of all radars  +-> OdometryFilter --+
///
/// The odometry takes scans in the order of their stamps: a complete scan waits for open scans that
/// began earlier.
///
/// With [vehicle], the filter also gets the speed and yaw rate of the vehicle's bus, and uses at a
/// scan what was measured before it.
///
/// With odometry.rate_hz, sinks receive the odometry of the last scan predicted to the times of
/// that rate, each when a frame, a time-out or silence reaches it.
///
/// Time is that of the stamps; `clock` is for durations only (solve_us, latency). Frames in the
/// order of their stamps therefore give the same results live and in a replay. After construction
/// nothing allocates, locks or logs.
class Pipeline {
 public:
  /// `source` (for its counters) and `sinks` must outlive the pipeline. `learned`: errors learned
  /// in an earlier drive, by radar; may be empty.
  Pipeline(const Configuration& configuration, const FrameSource& source,
           std::vector<OdometrySink*> sinks, PipelineClock clock,
           const std::vector<std::optional<LearnedErrors>>& learned = {});

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
  /// The learned errors, by radar, for the next start; empty unless the odometry is ok or
  /// standing_still. Not for the hot path.
  [[nodiscard]] std::vector<std::optional<LearnedErrors>> learned() const;
  /// Of a signal of [vehicle].
  [[nodiscard]] VehicleStatus vehicle(VehicleSignal signal) const;
  /// The odometry of the last scan; nothing before the first.
  [[nodiscard]] const std::optional<Odometry>& odometry() const { return odometry_; }

 private:
  /// `clock`: the interface of the frame, or StatusTimer::kNoInterface.
  void on_time(std::size_t clock, std::int64_t now_us);
  void note_clock(const CanFrame& frame);
  void expire(std::int64_t now_us, std::optional<std::uint8_t> interface = std::nullopt);
  template <typename Condition>
  RadarChannel* first_to_close(Condition condition);
  void publish_motions(RadarChannel& radar, std::int64_t begin_us);
  void publish(RadarChannel& radar, const RadarScan& scan, std::int64_t begin_us);
  [[nodiscard]] bool is_trusted(const RadarChannel& radar) const;
  void hold(RadarChannel& radar, const EgoMotion& motion);
  [[nodiscard]] RadarChannel* first_held() const;
  void publish_held();
  [[nodiscard]] bool is_awaiting(const RadarChannel& radar) const;
  void forget_motions();
  void forget_odometry();
  void publish_odometry(RadarChannel& radar);
  void reach(std::int64_t now_us);
  void publish_predictions(std::int64_t now_us);
  void publish_fused(std::size_t targets, std::int64_t solve_us);
  void publish_status();

  const FrameSource& source_;
  std::vector<OdometrySink*> sinks_;
  PipelineClock clock_;
  std::vector<std::unique_ptr<RadarChannel>> radars_;
  std::optional<OdometryFilter> filter_;
  VehicleListener vehicle_;
  BusClocks clocks_;
  bool is_predicted_;
  double standstill_mps_;
  std::optional<Odometry> odometry_;
  std::optional<std::int64_t> time_us_;  // Of the last frame.
  std::uint8_t last_interface_ = 0;      // Of the last frame.
  std::int64_t event_us_ = 0;            // Time of the event in progress.
  StatusTimer status_timer_;
};

}  // namespace cremed
