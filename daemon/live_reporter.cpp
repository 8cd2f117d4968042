// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/live_reporter.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>

#include <spdlog/spdlog.h>

#include "daemon/configuration/interfaces.hpp"
#include "daemon/output/multicast_route.hpp"
#include "daemon/process/message_text.hpp"
#include "daemon/report/report.hpp"

namespace cremed {
namespace {

/// Shorter pauses, such as one lost scan, are not reported.
constexpr int kPatienceS = 3;

/// In the order of kBusTexts.
enum BusCondition : std::uint8_t {
  good,
  absent,
  down,
  no_socket,
  bus_off,
  errors_only,
  error_passive,
  silent,
  late,
};

BusCondition condition_of(const BusStatus& now, const BusStatus& before) {
  switch (now.link) {
    case LinkState::absent:
      return absent;
    case LinkState::down:
      return down;
    case LinkState::failed:
      return no_socket;
    case LinkState::up:
    case LinkState::none:
      break;
  }
  if (now.bus == BusState::bus_off) {
    return bus_off;
  }
  const bool has_frames = now.frames != before.frames;
  if (!has_frames && now.error_frames != before.error_frames) {
    return errors_only;
  }
  if (now.bus == BusState::error_passive) {
    return error_passive;
  }
  if (has_frames) {
    return good;
  }
  return now.frames_stale != before.frames_stale ? late : silent;
}

/// Texts about the state of a bus.
struct BusText {
  std::string_view state;   ///< After its name.
  std::string_view remedy;  ///< With {name} of the interface and {error} of the socket.
};

constexpr std::array<BusText, 9> kBusTexts{{
    {"", ""},
    {" is missing", "no such CAN interface; waiting for it (list them: `ip link show type can`)"},
    {" is down",
     "is down; set it up: `ip link set {name} up type can bitrate 500000 restart-ms 100`"},
    {" has no socket", "no raw CAN socket: {error}; if the kernel lacks CAN: `modprobe can-raw`"},
    {" is bus-off",
     "bus-off, the controller has left the bus; to let it return by itself: `ip link set {name} "
     "type can restart-ms 100`"},
    {" has errors only",
     "error frames and no frame of a radar: is the bit rate right? `ip -details link show {name}`"},
    {" is error passive",
     "controller is error passive: check wiring, termination (120 ohm at both ends), bit rate"},
    {" is silent", "silent: no frame of a configured radar; `cremed-doctor` finds the cause"},
    {" is read too late",
     "no frame is read in time: all are dropped as older than live.max_latency_s"},
}};

}  // namespace

LiveReporter::LiveReporter(const Configuration& configuration, const Pipeline& pipeline,
                           const LiveSource& source, const MotionFeedback& feedback,
                           const LcmPublisher* publisher)
    : configuration_(configuration),
      pipeline_(pipeline),
      source_(source),
      feedback_(feedback),
      publisher_(publisher),
      buses_(source.interfaces().size()),
      progress_(configuration.radars.size()) {
  for (BusStatus& bus : buses_) {
    bus.link = LinkState::up;
  }
}

std::string LiveReporter::report() {
  std::string line;
  has_scans_ = false;
  for (std::size_t i = 0; i < progress_.size(); ++i) {
    line += (line.empty() ? "" : "; ") + report_radar(i) + report_feedback(i);
  }
  for (std::size_t i = 0; i < buses_.size(); ++i) {
    const BusStatus now = source_.bus(static_cast<std::uint8_t>(i));
    if (now.clock_steps != std::exchange(clock_steps_, now.clock_steps)) {  // The same of all.
      spdlog::warn("the clock was set: odometry restarts");
    }
    if (source_.interfaces()[i]->name() != kAutoInterface) {
      report_bus(*source_.interfaces()[i], now, buses_[i]);
    }
  }
  if (configuration_.odometry.enabled) {
    line += "; " + report_odometry();
  }
  for (const VehicleSignal signal : {VehicleSignal::speed, VehicleSignal::yaw_rate}) {
    if (configuration_.vehicle.is_used(signal)) {
      line += "; " + report_vehicle(signal);
    }
  }
  report_stale();
  report_publisher();
  if (publisher_ != nullptr && !publisher_->is_connected()) {
    line += "; LCM is not connected";
  }
  return line;
}

void LiveReporter::report_bus(const BusConnection& interface, const BusStatus& now,
                              BusStatus& before) {
  const std::string& name = interface.name();
  const BusCondition condition = condition_of(now, before);
  log_.update(name, condition, [&] {
    return fmt::format(fmt::runtime(kBusTexts.at(condition).remedy), fmt::arg("name", name),
                       fmt::arg("error", std::strerror(now.error)));
  });
  if (now.interruptions != before.interruptions && now.link == LinkState::up) {
    spdlog::warn("{}: was down for a moment", name);
  }
  if (now.bus_offs != before.bus_offs && now.bus != BusState::bus_off) {
    spdlog::warn("{}: was bus-off for a moment", name);
  }
  report_losses(name, now, before);
  before = now;
}

void LiveReporter::report_losses(const std::string& name, const BusStatus& now,
                                 const BusStatus& before) {
  log_.update(concat({name, " losses"}), now.frames_lost != before.frames_lost,
              "frames are lost: too many for this computer, or for the receive buffer; the scans "
              "they belong to are incomplete");
  log_.update(concat({name, " delay"}), now.frames_stale != before.frames_stale,
              "frames waited for longer than live.max_latency_s and are dropped: cremed did not "
              "run in time");
  const int wanted = configuration_.live.socket.receive_buffer_bytes;
  const bool is_clipped = now.receive_buffer_bytes != 0 && now.receive_buffer_bytes < wanted;
  log_.update(concat({name, " receive buffer"}), is_clipped ? 1 : 0, [&] {
    return fmt::format("{} bytes instead of {}: `sysctl -w net.core.rmem_max={}`",
                       now.receive_buffer_bytes, wanted, wanted);
  });
  log_.update(concat({name, " hardware stamps"}), !now.hardware_stamps_work,
              "missing, running backwards or not of the system's clock: the kernel's are used");
}

std::string LiveReporter::report_radar(std::size_t radar) {
  const RadarConfiguration& configuration = configuration_.radars[radar];
  if (is_auto(configuration)) {
    return concat({configuration.name, ": its CAN interface is not found yet"});
  }
  RadarChannel& channel = *pipeline_.radars()[radar];
  const RadarStatus& status = channel.status(0, source_);
  Progress& progress = progress_[radar];
  const std::uint64_t scans = status.assembler.scans - progress.scans;
  const std::uint64_t estimates = cremed::estimates(status) - progress.estimates;
  progress.scans += scans;
  progress.estimates += estimates;
  has_scans_ = has_scans_ || scans != 0;

  const BusCondition condition = condition_of(status.bus, buses_[channel.interface]);
  if (condition != good && scans == 0) {
    // The bus is the cause; the radar's own timer starts when frames come again.
    progress.seconds_without_scan = progress.seconds_without_estimate = 0;
    return concat(
        {configuration.name, ": ", configuration.interface, kBusTexts.at(condition).state});
  }
  progress.seconds_without_scan = scans == 0 ? progress.seconds_without_scan + 1 : 0;
  progress.seconds_without_estimate = estimates == 0 ? progress.seconds_without_estimate + 1 : 0;
  const int kind = progress.seconds_without_scan >= kPatienceS       ? 1
                   : progress.seconds_without_estimate >= kPatienceS ? 2
                                                                     : 0;
  log_.update(concat({"radar ", configuration.name}), kind, [&] {
    auto findings = radar_findings(configuration, status, configuration_.radars);
    if (const auto common = common_mount(configuration_, configuration, status);
        common && kind == 2) {
      findings.push_back(*common);
    }
    return concat({kind == 1 ? "no scans" : "no estimates", findings.empty() ? "" : ": ",
                   findings.empty() ? "" : to_text(findings.front())});
  });
  report_fault(radar, status);
  return fmt::format("{}: {} scans/s, {} estimates/s", configuration.name, scans, estimates);
}

/// Radars with findings of their own are reported there; this reports missing odometry although
/// there are scans.
std::string LiveReporter::report_odometry() {
  const std::optional<Odometry>& odometry = pipeline_.odometry();
  const bool is_new = odometry && odometry->utime_us != odometry_us_;
  odometry_us_ = odometry ? odometry->utime_us : 0;
  const bool is_good = is_new && odometry->is_usable();
  std::string state(is_new ? to_string(odometry->status) : "none");
  if (!has_scans_) {
    seconds_without_odometry_ = 0;
    return "odometry: " + state;
  }
  seconds_without_odometry_ = is_good ? 0 : seconds_without_odometry_ + 1;
  // Logged once; the status line shows later changes of the cause.
  log_.update("odometry", seconds_without_odometry_ >= kPatienceS, state.c_str());
  return "odometry: " + state;
}

std::string LiveReporter::report_vehicle(VehicleSignal signal) {
  const VehicleStatus status = pipeline_.vehicle(signal);
  const std::string name = vehicle_signal_name(signal);
  const SignalState state = signal_state(status);
  log_.update(name, static_cast<int>(state), [&] {
    return to_text(vehicle_findings(configuration_.vehicle, signal, status, false).front());
  });
  return concat({name, ": ", to_string(state)});
}

void LiveReporter::report_fault(std::size_t radar, const RadarStatus& status) {
  const RadarConfiguration& configuration = configuration_.radars[radar];
  FaultCause& cause = progress_[radar].cause;
  if (!status.odometry.is_left_out || status.odometry.cause.kind != FaultKind::unknown) {
    cause = status.odometry.cause;
  }
  const int state = 2 * static_cast<int>(cause.kind) + (status.odometry.is_left_out ? 1 : 0);
  log_.update(concat({configuration.name, " in the odometry"}), state, [&] {
    RadarStatus named = status;
    named.odometry.cause = cause;
    return to_text(fault_finding(configuration, named, configuration_.radars));
  });
}

std::string LiveReporter::report_feedback(std::size_t radar) {
  const bool has_rival = feedback_.has_rival(radar);
  log_.update(concat({configuration_.radars[radar].name, " motion_feedback"}), has_rival,
              "another node sends the sensor 0x300 or 0x301 too: nothing is sent until that is "
              "silent for 10 s; set motion_feedback = false, or stop the other");
  return has_rival ? ", motion_feedback paused: another node sends it" : "";
}

void LiveReporter::report_stale() {
  const std::uint64_t stale =
      pipeline_.stale_results() - std::exchange(stale_, pipeline_.stale_results());
  log_.update("results delay", stale != 0,
              "results older than live.max_latency_s are not sent: cremed did not run in time");
}

void LiveReporter::report_publisher() {
  if (publisher_ == nullptr) {
    return;
  }
  const bool was_connected = is_connected_;
  is_connected_ = publisher_->is_connected();
  const bool failing = was_connected && is_connected_ && publisher_->failures() != failures_;
  failures_ = publisher_->failures();
  log_.update("LCM publishing", failing ? 1 : 0, [&] {
    const std::string problem = multicast_problem(publisher_->url());
    return concat({"messages are lost", problem.empty() ? "" : ": ", problem});
  });
}

}  // namespace cremed
