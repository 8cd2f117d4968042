// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "cremed/estimator/fusion/odometry_filter.hpp"
#include "daemon/bus_clocks.hpp"
#include "daemon/configuration/configuration.hpp"
#include "daemon/output/odometry_sink.hpp"
#include "daemon/radar_channel.hpp"
#include "daemon/scan_queue.hpp"

namespace cremed {

/// Clock for durations; one that stands still, if it is not set, measures none.
struct PipelineClock {
  std::int64_t (*now_us)() = [] { return std::int64_t{0}; };
  /// true: `now_us` is the clock of the stamps, latency counts from the stamp of a scan's last
  /// frame, and results that are too old are not sent (Outputs); false: from the call of
  /// on_frame(), and all are sent.
  bool is_stamp_clock = false;
};

/// From the scans of all radars to the odometry: the filter takes them in the order of their
/// stamps. A complete scan waits in a queue for open scans that began earlier, on buses whose
/// clocks agree. With odometry.rate_hz the outputs receive the state predicted to the times of that
/// rate instead of that at each scan.
///
/// Does nothing if odometry.enabled = false.
class OdometryStage {
 public:
  using Radars = std::vector<std::unique_ptr<RadarChannel>>;

  /// All but `configuration` must outlive the stage.
  OdometryStage(const Configuration& configuration,
                const std::vector<std::optional<LearnedErrors>>& learned, const Radars& radars,
                const BusClocks& clocks, OdometrySink& outputs, PipelineClock clock);

  /// Null if odometry.enabled = false.
  OdometryFilter* filter() { return filter_ ? &*filter_ : nullptr; }
  [[nodiscard]] const OdometryFilter* filter() const { return filter_ ? &*filter_ : nullptr; }
  /// The odometry of the last scan used; nothing before the first.
  [[nodiscard]] const std::optional<Odometry>& odometry() const { return odometry_; }

  /// Uses the waiting scans up to this radar's, whose targets are replaced by its next scan.
  void make_room(std::size_t radar);
  /// The radar's targets wait for their turn.
  void hold(const RadarChannel& radar, std::int64_t stamp_us);
  /// Uses the scans whose turn has come.
  void use_ready();
  /// Time passes: scans that have waited long enough, and predictions that are due, each at its
  /// own time.
  void advance_to(std::int64_t now_us);
  /// No odometry spans this moment.
  void forget();

 private:
  [[nodiscard]] bool is_awaiting(const ScanQueue::Scan& scan) const;
  [[nodiscard]] bool is_trusted(const RadarChannel& radar) const;
  void use(const ScanQueue::Scan& scan);
  void predict_to(std::int64_t now_us);

  const Radars& radars_;
  const BusClocks& clocks_;
  OdometrySink& outputs_;
  PipelineClock clock_;
  std::optional<OdometryFilter> filter_;
  ScanQueue queue_;
  std::optional<Odometry> odometry_;
  std::int64_t now_us_ = 0;  // Of the event in progress.
  bool is_predicted_;
  double standstill_mps_;
};

}  // namespace cremed
