// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/bus_findings.hpp"

#include <algorithm>
#include <cstdint>
#include <string>

#include "daemon/process/joined.hpp"
#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

constexpr int kWantedBufferBytes = 1 << 20;

/// A virtual interface has no wires and no bit rate.
bool is_virtual(const BusObservation& bus) { return bus.interface.starts_with("vcan"); }

std::string up_command(const BusObservation& bus) {
  return is_virtual(bus) ? concat({"`ip link set ", bus.interface, " up`"})
                         : concat({"`ip link set ", bus.interface,
                                   " up type can bitrate 500000 restart-ms 100`"});
}

/// The bit rate can be changed only while the interface is down.
std::string bit_rate_command(const BusObservation& bus) {
  return concat({"`ip link set ", bus.interface, " down; ip link set ", bus.interface,
                 " up type can bitrate 500000 restart-ms 100`"});
}

std::string statistics_command(const BusObservation& bus) {
  return concat({"`ip -details -statistics link show ", bus.interface, "`"});
}

std::string other_interfaces(const Observation& observation) {
  const auto is_other = [](const BusObservation& bus) {
    return bus.state != InterfaceState::absent && bus.state != InterfaceState::not_can;
  };
  return joined_if(observation.buses, is_other, &BusObservation::interface);
}

Finding absent(const BusObservation& bus, const Observation& observation) {
  const std::string others = other_interfaces(observation);
  if (!observation.is_live) {
    return {Severity::error, concat({"the log has no frame of interface ", bus.interface}),
            concat({"record that bus too, or set interface to one of these: ", others})};
  }
  const std::string remedy =
      is_virtual(bus)
          ? concat({"`ip link add ", bus.interface, " type vcan && ip link set ", bus.interface,
                    " up`"})
          : "plug in its adapter and load its driver (`ip -brief link show type can` lists them)";
  return {Severity::error, concat({"there is no interface ", bus.interface}),
          others.empty() ? remedy
                         : concat({remedy, ", or set interface to an existing one: ", others})};
}

/// Why a live interface receives nothing.
Finding state_finding(const BusObservation& bus, const Observation& observation) {
  switch (bus.state) {
    case InterfaceState::absent:
      return absent(bus, observation);
    case InterfaceState::not_can:
      return {Severity::error, concat({bus.interface, " is no CAN interface"}),
              "set interface to one (`ip -brief link show type can` lists them)"};
    case InterfaceState::down:
      return {Severity::error, concat({bus.interface, " is down"}),
              concat({up_command(bus),
                      is_virtual(bus) ? "" : "; for good: systemd/80-can.network of cremed"})};
    case InterfaceState::bus_off:
      return {Severity::error,
              concat({bus.interface, " is bus-off: its controller left the bus after errors"}),
              concat({"check wiring and bit rate, then ", bit_rate_command(bus)})};
    case InterfaceState::failed:
      return {Severity::error, concat({bus.interface, " cannot be read: ", bus.error}),
              "run as a user who may open CAN sockets"};
    case InterfaceState::up:
      break;
  }
  return {};
}

Finding silence(const BusObservation& bus, double seconds) {
  const BusStatus& status = bus.status;
  if (status.error_frames != 0) {
    return {Severity::error,
            concat({"nothing but errors on ", bus.interface, " (",
                    counted(status.error_frames, "error frame"),
                    "): its bit rate is not that of the bus"}),
            bit_rate_command(bus)};
  }
  return {Severity::error, concat({"no frame on ", bus.interface, " in ", tenths(seconds), " s"}),
          is_virtual(bus)
              ? "replay a log on it, `canplayer -I LOG`"
              : concat({"check the radar's power, the cable and its two 120 ohm terminations; ",
                        statistics_command(bus)})};
}

void add_errors(const BusObservation& bus, std::vector<Finding>& findings) {
  const BusStatus& status = bus.status;
  const std::string frames = counted(status.error_frames, "error frame");
  if (status.bus_offs != 0) {
    findings.push_back({Severity::warning,
                        concat({bus.interface, " went bus-off ", number(status.bus_offs),
                                " times: the controller left the bus after errors"}),
                        concat({"check wiring and termination; for automatic recovery: ",
                                bit_rate_command(bus)})});
  } else if (bus.no_acknowledge != 0) {
    findings.push_back(
        {Severity::warning,
         concat({"no node acknowledges frames on ", bus.interface, " (", frames, ")"}),
         "check the radar's power and the cable; do not send unless needed"});
  } else if (bus.protocol_errors != 0 || status.bus != BusState::error_active) {
    findings.push_back({Severity::warning,
                        concat({"bus errors on ", bus.interface, " (", frames, " among ",
                                number(status.frames), ")"}),
                        concat({"check wiring, termination and that all nodes have the same bit "
                                "rate; ",
                                statistics_command(bus)})});
  }
}

void add_losses(const BusObservation& bus, std::vector<Finding>& findings) {
  constexpr const char* kRaise = "`sysctl -w net.core.rmem_max=1048576`";
  const std::uint64_t dropped = bus.status.frames_lost - bus.overruns;
  const int granted_bytes = bus.status.receive_buffer_bytes;
  const bool is_small = granted_bytes != 0 && granted_bytes < kWantedBufferBytes;
  if (bus.overruns != 0) {
    findings.push_back({Severity::warning,
                        concat({"the controller of ", bus.interface, " lost frames ",
                                counted(bus.overruns, "time"), ": it was not read in time"}),
                        "use another adapter, or find what delays interrupts"});
  }
  if (dropped != 0) {
    findings.push_back(
        {Severity::warning,
         concat({counted(dropped, "frame"), " of ", bus.interface, " lost before they were read"}),
         concat({is_small ? concat({"allow a larger receive buffer, ", kRaise, ", and "}) : "",
                 "find what keeps the processor busy"})});
  } else if (is_small) {
    findings.push_back(
        {Severity::note,
         concat({"the kernel grants ", number(static_cast<std::uint64_t>(granted_bytes)),
                 " bytes of receive buffer on ", bus.interface, ": too few for a busy computer"}),
         kRaise});
  }
}

void add_clock(const BusObservation& bus, const Observation& observation,
               std::vector<Finding>& findings) {
  const double leap_s = static_cast<double>(bus.longest_leap_us) * 1e-6;
  if (leap_s >= kLongestPauseS && !observation.is_live && observation.forward_steps == 0) {
    findings.push_back(
        {Severity::note,
         concat({"the stamps of ", bus.interface, " leap forward by ", tenths(leap_s), " s"}),
         "the clock was set, the recording paused, or logs were joined: no motion spans it"});
  }
  if (bus.stamps_back == 0) {
    return;
  }
  const double back_s = static_cast<double>(bus.longest_back_us) * 1e-6;
  findings.push_back(
      {Severity::warning,
       concat({"the stamps of ", bus.interface, " run backwards ", counted(bus.stamps_back, "time"),
               ", by up to ", tenths(std::max(back_s, 0.1)), " s"}),
       observation.is_live
           ? "the clock was set meanwhile: listen again, and find what sets it, `timedatectl`"
           : "the clock was set during the recording, or lines are out of order: "
             "`sort -s -k1,1 LOG` corrects the latter"});
}

}  // namespace

bool is_silent(const BusObservation& bus) {
  return bus.state != InterfaceState::up || bus.status.frames == 0;
}

std::vector<Finding> bus_findings(const BusObservation& bus, const Observation& observation) {
  std::vector<Finding> findings;
  if (bus.state != InterfaceState::up) {
    findings.push_back(state_finding(bus, observation));
    return findings;
  }
  if (bus.status.frames == 0) {
    findings.push_back(silence(bus, observation.seconds));
  }
  if (bus.status.frames != 0 || bus.status.bus_offs != 0) {
    add_errors(bus, findings);
  }
  add_clock(bus, observation, findings);
  add_losses(bus, findings);
  return findings;
}

}  // namespace cremed
