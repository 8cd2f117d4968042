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
#include "daemon/configuration/configuration.hpp"
#include "daemon/output/odometry_sink.hpp"
#include "daemon/radar_channel.hpp"
#include "daemon/report/status_timer.hpp"
#include "daemon/source/frame_source.hpp"

namespace cremed {

/// How durations are measured.
struct PipelineClock {
  std::int64_t (*now_us)();
  /// true: `now_us` is the clock of the frames' stamps, and latency counts from the stamp of a
  /// scan's last frame; false: it counts from when that frame was handed in.
  bool is_that_of_stamps = false;
};

/// The whole way from a frame to a message:
///
///     FrameSource -> RadarDecoder -> ScanAssembler -> EgoMotionEstimator -> OdometrySink
///                                                          |                    |
///                                           of all radars  +-> OdometryFilter --+
///
/// The odometry takes scans in the order of their stamps: one that is whole waits for those that
/// began before it and are still coming in.
///
/// With odometry.rate_hz sinks are told the odometry of the last scan predicted to the times of
/// that rate, each once the stamp of a frame, a time-out or silence has reached it.
///
/// Time is that of the frames' stamps; `clock` is for durations only: solve_us and latency. So
/// frames that come in the order of their stamps give the same motions in the same order, live and
/// in a replay. After construction nothing allocates, locks or logs.
class Pipeline {
 public:
  /// `source` (for its counters) and `sinks` must outlive the pipeline. `learned`: of the radars in
  /// a drive before; may be empty.
  Pipeline(const Configuration& configuration, const FrameSource& source,
           std::vector<OdometrySink*> sinks, PipelineClock clock,
           const std::vector<std::optional<LearnedErrors>>& learned = {});

  /// Takes the source's next event all the way; false at its end. The loop of the daemon.
  bool take_next(FrameSource& source);
  /// What a source reported, with what it set in `frame`.
  void on_event(SourceEvent event, const CanFrame& frame);

  void on_frame(const CanFrame& frame);
  /// Frames were lost on an interface: scans open on it cannot be whole.
  void on_dropped(std::uint8_t interface);
  /// The clock of the stamps was set: what is open is void, and no motion spans the step.
  void on_clock_step();
  /// Nothing to read: time passes nonetheless. `now_us` is of the clock of the stamps.
  void on_idle(std::int64_t now_us);
  /// No more frames: closes open scans and reports a last status.
  void finish();

  /// No scan can be whole before so many more frames have come; 0 if no scan is open.
  [[nodiscard]] std::size_t frames_to_next_scan() const;

  /// The radar's frames are those of this interface from now on.
  void set_interface(std::size_t radar, std::uint8_t interface) {
    radars_[radar]->interface = interface;
  }

  [[nodiscard]] const std::vector<std::unique_ptr<RadarChannel>>& radars() const { return radars_; }
  /// What the odometry learned of the radars, by radar, for a next start; empty while it is neither
  /// ok nor standing_still. Not for the hot path.
  [[nodiscard]] std::vector<std::optional<LearnedErrors>> learned() const;
  /// The last at a scan; nothing before the first.
  [[nodiscard]] const std::optional<Odometry>& odometry() const { return odometry_; }

 private:
  /// `clock`: the interface whose frame tells the time, or StatusTimer::kNoInterface.
  void on_time(std::size_t clock, std::int64_t now_us);
  void note_clock(const CanFrame& frame);
  void expire(std::int64_t now_us, std::optional<std::uint8_t> told_by = std::nullopt);
  template <typename Condition>
  RadarChannel* first_to_close(Condition condition);
  void publish_motions(RadarChannel& radar, std::int64_t begin_us);
  void publish(RadarChannel& radar, const RadarScan& scan, std::int64_t begin_us);
  [[nodiscard]] bool is_believed(const RadarChannel& radar) const;
  void hold(RadarChannel& radar, const EgoMotion& motion);
  [[nodiscard]] RadarChannel* first_held() const;
  void publish_held();
  [[nodiscard]] bool is_awaiting(const RadarChannel& radar) const;
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
  bool is_predicted_;
  double standstill_mps_;
  std::optional<Odometry> odometry_;
  std::optional<std::int64_t> time_us_;  // Of the last frame; none yet.
  std::uint8_t last_interface_ = 0;      // Of the last frame.
  std::int64_t event_us_ = 0;            // What happens now happens at that time.
  StatusTimer status_timer_;
};

}  // namespace cremed
