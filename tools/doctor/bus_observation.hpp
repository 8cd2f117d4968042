// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "cremed/can_decoders/bus_traffic.hpp"
#include "cremed/can_decoders/can_frame.hpp"
#include "daemon/source/bus_status.hpp"

namespace cremed {

/// What the kernel says about an interface, or the log: there, one is `up` or `absent`.
enum class InterfaceState : std::uint8_t {
  up,
  down,
  bus_off,  ///< Up, but its controller has cut itself off the bus.
  absent,
  not_can,  ///< An interface of another kind.
  failed,   ///< The kernel refused a socket.
};

/// Everything seen of one bus.
struct BusObservation {
  std::string interface;
  InterfaceState state = InterfaceState::up;
  std::string error;                  ///< What the kernel said, if failed.
  BusStatus status;                   ///< Counters, error frames, receive buffer.
  std::uint64_t protocol_errors = 0;  ///< Error frames that report bit, stuff, form or CRC errors.
  std::uint64_t no_acknowledge = 0;   ///< Error frames that report that nobody listens.
  std::uint64_t overruns = 0;         ///< Error frames that report frames the controller lost.
  std::uint64_t foreign_frames = 0;   ///< Extended, remote or FD: no radar here sends them.
  std::uint64_t stamps_back = 0;      ///< Frames that are stamped before the one they follow.
  std::int64_t longest_back_us = 0;   ///< The longest of these steps.
  std::optional<std::int64_t> last_stamp_us;
  BusTraffic traffic;

  void add(const CanFrame& frame);

 private:
  void note_stamp(std::int64_t stamp_us);
};

/// The first identifiers on a bus, and what else is on it: "0x123, 0x124".
std::string seen_ids(const BusObservation& bus);

}  // namespace cremed
