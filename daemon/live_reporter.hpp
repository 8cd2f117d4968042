// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/configuration/configuration.hpp"
#include "daemon/output/lcm_publisher.hpp"
#include "daemon/pipeline.hpp"
#include "daemon/report/condition_log.hpp"
#include "daemon/source/bus_status.hpp"
#include "daemon/source/live_source.hpp"

namespace cremed {

/// What a live daemon says of itself: once a second a line for `systemctl status`, and in the log
/// what is wrong with buses, radars and LCM, when it begins and when it ends. Off the hot path: it
/// builds texts.
class LiveReporter {
 public:
  /// All but `configuration` must outlive it; `publisher` may be null.
  LiveReporter(const Configuration& configuration, const Pipeline& pipeline,
               const LiveSource& source, const LcmPublisher* publisher);

  /// The interface of a radar that had none is known.
  void set_interface(std::size_t radar, const std::string& name) {
    configuration_.radars[radar].interface = name;
  }

  /// Looks at everything. Called once a second; returns the line.
  std::string report();

 private:
  /// What a radar had done when last looked at.
  struct Progress {
    std::uint64_t scans = 0;
    std::uint64_t estimates = 0;
    int seconds_without_scan = 0;
    int seconds_without_estimate = 0;
  };
  void report_bus(const BusConnection& interface, const BusStatus& now, BusStatus& before);
  void report_losses(const std::string& name, const BusStatus& now, const BusStatus& before);
  std::string report_radar(std::size_t radar);
  std::string report_odometry();
  void report_left_out(std::size_t radar, const RadarStatus& status);
  void report_publisher();

  Configuration configuration_;
  const Pipeline& pipeline_;
  const LiveSource& source_;
  const LcmPublisher* publisher_;
  ConditionLog log_;
  std::vector<BusStatus> buses_;  // As last looked at.
  std::vector<Progress> progress_;
  bool has_scans_ = false;        // Of any radar, since then.
  std::int64_t odometry_us_ = 0;  // As last looked at.
  int seconds_without_odometry_ = 0;
  bool is_connected_ = false;
  std::uint64_t failures_ = 0;
};

}  // namespace cremed
