// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "can_decoders/can_frame.hpp"
#include "daemon/bus_status.hpp"

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

/// What one identifier carried.
struct IdObservation {
  std::uint64_t frames = 0;
  std::uint8_t length = 0;  ///< Of the last frame.
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
  std::array<IdObservation, 0x800> ids{};

  void add(const CanFrame& frame);
};

}  // namespace cremed
