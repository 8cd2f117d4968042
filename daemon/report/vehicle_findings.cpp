// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/report/vehicle_findings.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include <spdlog/fmt/fmt.h>

#include "cremed/estimator/scan/degrees.hpp"
#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

std::string times_text(bool is_present, int times) {
  return is_present ? "" : fmt::format(" for a while, {} time{}", times, times == 1 ? "" : "s");
}

/// `seen`: share of the reading that is wrong.
std::string scale_text(double seen) {
  const double right = 1.0 - seen;
  if (right < 0.0) {
    return ": its sign is wrong";
  }
  // Beyond a factor of ten the unit is wrong, and the share tells it no better than that.
  if (right < 0.1) {
    return ": it is more than ten times too large";
  }
  const double percent = 100.0 * seen / right;
  return fmt::format(": it is {:.1f} % too {}", std::abs(percent),
                     percent > 0.0 ? "large" : "small");
}

/// What the radars see wrong with it: ": it is 10.2 % too large".
std::string fault_text(VehicleSignal signal, const VehicleSignalReport& report) {
  const bool is_speed = signal == VehicleSignal::speed;
  switch (report.fault) {
    case SignalFault::scale:
      return scale_text(report.seen_scale);
    case SignalFault::delay:
      return fmt::format(": it comes {:.2f} s {} than configured", std::abs(report.seen_delay_s),
                         report.seen_delay_s > 0.0 ? "later" : "earlier");
    case SignalFault::offset:
      return fmt::format(": its offset is {:+.2f} {}",
                         report.seen_offset * (is_speed ? 1.0 : kDegPerRad),
                         is_speed ? "m/s" : "deg/s");
    case SignalFault::none:
      break;
  }
  return fmt::format(" (normalised innovation squared {:.1f}, 1 expected)", report.nis);
}

}  // namespace

std::string vehicle_signal_name(VehicleSignal signal) {
  return signal == VehicleSignal::speed ? "vehicle speed" : "vehicle yaw rate";
}

SignalState signal_state(const VehicleStatus& status) {
  const VehicleSignalReport& report = status.odometry;
  return report.is_lost       ? SignalState::lost
         : report.is_frozen   ? SignalState::frozen
         : report.is_left_out ? SignalState::excluded
                              : SignalState::ok;
}

std::string_view to_string(SignalState state) {
  constexpr std::array<std::string_view, 4> kNames{"ok", "lost", "frozen", "excluded"};
  return kNames[static_cast<std::size_t>(state)];
}

std::string vehicle_summary(VehicleSignal signal, const VehicleStatus& status) {
  const VehicleSignalReport& report = status.odometry;
  const std::string errors =
      fmt::format("scale {:+.2f} +- {:.2f} %", 100.0 * report.scale, 100.0 * report.scale_std);
  return fmt::format(
      "{} frames, {} measurements, {}{}", report.readings, report.measurements_used, errors,
      signal == VehicleSignal::speed
          ? std::string()
          : fmt::format(", bias {:+.3f} +- {:.3f} deg/s", kDegPerRad * report.bias_radps,
                        kDegPerRad * report.bias_std_radps));
}

std::vector<Finding> vehicle_findings(const VehicleConfiguration& vehicle, VehicleSignal signal,
                                      const VehicleStatus& status, bool with_past) {
  const VehicleSignalReport& report = status.odometry;
  const std::string id = hexadecimal(vehicle.id(signal).value_or(0));
  std::vector<Finding> findings;
  const auto is_named = [with_past](bool is_present, int times) {
    return is_present || (with_past && times > 0);
  };
  if (is_named(report.is_lost, report.times_lost)) {
    const std::string missing = concat({"no ", status.bad_frames != 0 ? "readable " : "", "frame ",
                                        id, " on ", vehicle.interface});
    findings.push_back(
        {Severity::warning,
         report.readings == 0
             ? missing
             : concat({"lost: ", missing, times_text(report.is_lost, report.times_lost)}),
         "check its sender, or set [vehicle] interface = \"off\"; the radars go on without it"});
  }
  if (is_named(report.is_frozen, report.times_frozen)) {
    findings.push_back({Severity::warning,
                        concat({"frozen: ", id, " repeats one value while the radars see it change",
                                times_text(report.is_frozen, report.times_frozen)}),
                        "check its sender and its sensor"});
  }
  if (is_named(report.is_left_out, report.times_left_out)) {
    findings.push_back({Severity::warning,
                        concat({"excluded from the odometry: ", id, " contradicts the radars",
                                times_text(report.is_left_out, report.times_left_out),
                                fault_text(signal, report)}),
                        "check its unit, sign, factor and delay ([vehicle])"});
  }
  if (status.bad_frames != 0) {
    findings.push_back(
        {Severity::warning,
         concat({counted(status.bad_frames, "frame"), " ", id,
                 " cannot be read: too short, remote, FD, or a speed that its direction "
                 "contradicts"}),
         "is it laid out as for an ARS408?"});
  }
  return findings;
}

}  // namespace cremed
