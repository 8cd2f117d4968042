// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "cremed/can_decoders/ars408.hpp"
#include "cremed/can_decoders/ars408_messages.hpp"
#include "cremed/can_decoders/bus_traffic.hpp"
#include "cremed/can_decoders/can_frame.hpp"
#include "daemon/source/bus_status.hpp"

namespace cremed {

/// State of an interface; in a log only `up` or `absent`.
enum class InterfaceState : std::uint8_t {
  up,
  down,
  bus_off,  ///< Up, but its controller has left the bus.
  absent,
  not_can,  ///< Not a CAN interface.
  failed,   ///< The kernel refused a socket.
};

/// Observations of one bus.
struct BusObservation {
  std::string interface;
  InterfaceState state = InterfaceState::up;
  std::string error;                  ///< The kernel's error, if failed.
  BusStatus status;                   ///< Counters, error frames, receive buffer.
  std::uint64_t protocol_errors = 0;  ///< Error frames that report bit, stuff, form or CRC errors.
  std::uint64_t no_acknowledge = 0;   ///< Error frames that report a missing acknowledge.
  std::uint64_t overruns = 0;         ///< Error frames that report frames the controller lost.
  std::uint64_t foreign_frames = 0;   ///< Extended, remote or FD: not sent by the supported radars.
  std::uint64_t stamps_back = 0;      ///< Frames with an earlier stamp than the frame before.
  std::int64_t longest_back_us = 0;   ///< The longest of these steps.
  std::int64_t longest_leap_us = 0;   ///< The longest step forward.
  std::optional<std::int64_t> last_stamp_us;
  BusTraffic traffic;

  void add(const CanFrame& frame);

 private:
  void note_stamp(std::int64_t stamp_us);
};

/// Frames of this message that a sensor with these options has sent.
std::uint64_t frames_of(const Ars408Options& sensor, Ars408Message message, const BusTraffic& bus);

/// The first identifiers on a bus, and other frames: "0x123, 0x124".
std::string seen_ids(const BusObservation& bus);

}  // namespace cremed
