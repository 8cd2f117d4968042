// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/configuration/configuration.hpp"
#include "daemon/motion_feedback.hpp"
#include "daemon/output/lcm_publisher.hpp"
#include "daemon/pipeline.hpp"
#include "daemon/report/condition_log.hpp"
#include "daemon/source/bus_status.hpp"
#include "daemon/source/live_source.hpp"

namespace cremed {

/// Reports of the live daemon: once a second a line for `systemctl status`, and log lines when a
/// fault of buses, radars or LCM begins and ends. Builds texts, so it is not for the hot path.
class LiveReporter {
 public:
  /// All arguments but `configuration` must outlive it; `publisher` may be null.
  LiveReporter(const Configuration& configuration, const Pipeline& pipeline,
               const LiveSource& source, const MotionFeedback& feedback,
               const LcmPublisher* publisher);

  /// The interface of a radar with "auto" was found.
  void set_interface(std::size_t radar, const std::string& name) {
    configuration_.radars[radar].interface = name;
  }

  /// Checks everything. Called once a second; returns the status line.
  std::string report();

 private:
  /// State of a radar at the last check.
  struct Progress {
    std::uint64_t scans = 0;
    std::uint64_t estimates = 0;
    int seconds_without_scan = 0;
    int seconds_without_estimate = 0;
    FaultCause cause;  // The last that was named since the radar was left out.
  };
  void report_bus(const BusConnection& interface, const BusStatus& now, BusStatus& before);
  void report_losses(const std::string& name, const BusStatus& now, const BusStatus& before);
  std::string report_radar(std::size_t radar);
  std::string report_odometry();
  std::string report_vehicle(VehicleSignal signal);
  void report_fault(std::size_t radar, const RadarStatus& status);
  std::string report_feedback(std::size_t radar);
  void report_stale();
  void report_publisher();

  Configuration configuration_;
  const Pipeline& pipeline_;
  const LiveSource& source_;
  const MotionFeedback& feedback_;
  const LcmPublisher* publisher_;
  ConditionLog log_;
  std::vector<BusStatus> buses_;  // At the last check.
  std::uint64_t clock_steps_ = 0;
  std::vector<Progress> progress_;
  bool has_scans_ = false;        // Of any radar, since the last check.
  std::int64_t odometry_us_ = 0;  // At the last check.
  int seconds_without_odometry_ = 0;
  bool is_connected_ = false;
  std::uint64_t failures_ = 0;
  std::uint64_t stale_ = 0;  // At the last check.
};

}  // namespace cremed
