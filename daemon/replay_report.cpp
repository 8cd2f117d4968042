// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/replay_report.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <spdlog/spdlog.h>

#include "cremed/estimator/scan/stamps.hpp"
#include "daemon/configuration/interfaces.hpp"
#include "daemon/process/joined.hpp"
#include "daemon/process/message_text.hpp"
#include "daemon/report/report.hpp"

namespace cremed {
namespace {

void log_finding(const std::string& radar, const Finding& finding) {
  const auto level = finding.severity == Severity::error     ? spdlog::level::err
                     : finding.severity == Severity::warning ? spdlog::level::warn
                                                             : spdlog::level::info;
  spdlog::log(level, "{}: {}", radar, to_text(finding));
}

void log_vehicle(const Configuration& configuration, const Pipeline& pipeline) {
  for (const VehicleSignal signal : {VehicleSignal::speed, VehicleSignal::yaw_rate}) {
    if (configuration.vehicle.is_used(signal)) {
      const VehicleStatus status = pipeline.vehicle(signal);
      const std::string name = vehicle_signal_name(signal);
      spdlog::info("{}: {}", name, vehicle_summary(signal, status));
      for (const Finding& finding : vehicle_findings(configuration.vehicle, signal, status, true)) {
        log_finding(name, finding);
      }
    }
  }
}

/// Logs the faults of the logs; false if one cannot be used.
bool report_logs(const Replay& replay) {
  bool good = true;
  for (const CandumpReader& log : replay.logs()) {
    for (const std::string& fault : {log.malformed(), log.cut_off()}) {
      if (!fault.empty()) {
        spdlog::warn("{}", fault);
      }
    }
    if (const std::string problem = log.problem(); !problem.empty()) {
      spdlog::error("{}", problem);
      good = false;
    }
  }
  if (replay.counters().lost_frames != 0) {
    spdlog::warn("{} frames were lost before they were logged", replay.counters().lost_frames);
  }
  return good;
}

void report_clock(const ForwardSteps& steps) {
  if (steps.count != 0) {
    spdlog::warn(
        "the clock was set forward while this was recorded, {}, by up to {:.2f} s: the radars "
        "count their cycles on; no motion spans it",
        counted(steps.count, "time"), steps.longest_s);
  }
}

/// One of several logs may lack an interface; that is no fault.
void report_absent_interfaces(const Configuration& configuration, const Replay& replay) {
  const std::string others = joined(replay.other_interfaces(), printable);
  const std::vector<std::string> names = interface_names(configuration);
  for (std::size_t i = 0; !others.empty() && i < names.size(); ++i) {
    if (!replay.has_frames(i)) {
      spdlog::error(
          "the input has no frame of interface {}; record that bus too, or set interface to one of "
          "these: {}",
          names[i], others);
    }
  }
}

/// The command line that finds the cause, as for a shell.
std::string doctor_command(const Replayed& replayed) {
  const std::string logs = joined(
      replayed.replay.logs(),
      [](const CandumpReader& log) { return "--replay " + in_shell(log.path()); }, " ");
  return concat(
      {"`cremed-doctor --config ", in_shell(replayed.configuration_path), " ", logs, "`"});
}

/// A radar that ended before the log: the numbers of scans do not show it. Where the clocks of the
/// buses differ, the last frame does not tell when that was.
void report_end(const Replayed& replayed, const std::string& name, const RadarStatus& status) {
  constexpr double kLeastMissingS = 3.0;
  const std::int64_t end_us = replayed.replay.last_stamp_us();
  const double missing_s = seconds_between(status.utime_last_estimate_us, end_us);
  const double log_s = replayed.replay.traffic_s();
  const bool are_clocks_alike =
      std::ranges::none_of(replayed.pipeline.radars(),
                           [](const auto& each) { return each->is_ahead || each->is_behind; });
  if (are_clocks_alike && estimates(status) != 0 && missing_s > kLeastMissingS &&
      missing_s < log_s) {
    spdlog::warn("{}: no estimate in the last {:.1f} of {:.1f} s; {} tells why", name, missing_s,
                 log_s, doctor_command(replayed));
  }
}

RadarStatus status_of(const Replayed& replayed, std::size_t number) {
  RadarStatus status = replayed.pipeline.radars()[number]->status(0, replayed.replay);
  if (reversed_odometry(replayed.odometry, replayed.configuration.radars.size())) {
    drop_doubts_of_turned_mount(status);
  }
  return status;
}

/// False if it had no scan.
bool report_radar(const Replayed& replayed, std::size_t number) {
  const RadarConfiguration& radar = replayed.configuration.radars[number];
  const RadarStatus status = status_of(replayed, number);
  spdlog::info("{}: {}", radar.name, summary(status));
  // Without a frame there is nothing to find in them.
  for (const Finding& finding : status.decoder.frames != 0
                                    ? radar_findings(radar, status, replayed.configuration.radars)
                                    : std::vector<Finding>()) {
    log_finding(radar.name, finding);
  }
  if (const std::string text = irregularities(status); !text.empty()) {
    spdlog::warn("{}: {}", radar.name, text);
  }
  if (status.assembler.scans == 0) {
    spdlog::error("{}: no {} of this radar in the input; {} tells why", radar.name,
                  status.decoder.frames == 0 ? "frame" : "scan", doctor_command(replayed));
  }
  if (!replayed.is_stopped) {
    report_end(replayed, radar.name, status);
  }
  return status.assembler.scans != 0;
}

/// False if one had no scan, or none an estimate.
bool report_radars(const Replayed& replayed) {
  const Configuration& configuration = replayed.configuration;
  bool is_good = true;
  std::optional<Finding> common;
  std::uint64_t scans = 0;
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < configuration.radars.size(); ++i) {
    is_good = report_radar(replayed, i) && is_good;
    const RadarStatus status = status_of(replayed, i);
    scans += status.assembler.scans;
    count += estimates(status);
    common = common ? common : common_mount(configuration, configuration.radars[i], status);
  }
  if (common) {
    spdlog::error("{}", to_text(*common));
  }
  if (scans != 0 && count == 0) {
    spdlog::error("no estimate from {}; {} tells why", counted(scans, "scan"),
                  doctor_command(replayed));
  }
  return is_good && count != 0;
}

/// How much of the drive has an odometry: a radar's own estimates do not tell.
void log_odometry(const OdometryTally& tally, std::size_t radars) {
  std::string text;
  for (std::size_t i = 0; i < kOdometryStatusCount; ++i) {
    const auto status = static_cast<OdometryStatus>(i);
    if (tally.count(status) != 0) {
      text +=
          fmt::format("{}{} {}", text.empty() ? "" : ", ", to_string(status), tally.count(status));
    }
  }
  const bool is_usable =
      tally.count(OdometryStatus::ok) + tally.count(OdometryStatus::standing_still) != 0;
  spdlog::log(is_usable ? spdlog::level::info : spdlog::level::warn, "odometry: {}",
              is_usable ? text : concat({"never usable: ", text.empty() ? "no scan" : text}));
  if (is_usable) {
    for (const Finding& finding : odometry_findings(tally, radars)) {
      spdlog::warn("{}", to_text(finding));  // A note too: cremed-report looks for warnings only.
    }
  }
}

}  // namespace

bool report_replay(const Replayed& replayed) {
  const SourceCounters& counters = replayed.replay.counters();
  if (counters.frames + counters.other_interface_frames == 0) {
    if (replayed.is_stopped) {
      return report_logs(replayed.replay);
    }
    for (const CandumpReader& log : replayed.replay.logs()) {
      const std::string problem = log.problem();
      spdlog::error("{}", problem.empty() ? log.no_frame() : problem);
    }
    return false;
  }
  if (!report_logs(replayed.replay)) {
    return false;
  }
  if (!replayed.is_stopped) {
    report_absent_interfaces(replayed.configuration, replayed.replay);
  }
  report_clock(replayed.pipeline.forward_steps());
  const bool is_good = report_radars(replayed);
  if (replayed.configuration.odometry.enabled) {
    log_odometry(replayed.odometry, replayed.configuration.radars.size());
  }
  log_vehicle(replayed.configuration, replayed.pipeline);
  return is_good || replayed.is_stopped;
}

}  // namespace cremed
