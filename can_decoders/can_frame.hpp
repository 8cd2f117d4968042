// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

namespace cremed {

/// One frame as it was on a bus. Plain data: who made it (socket, log, simulator) does not matter.
struct CanFrame {
  std::int64_t stamp_us = 0;   ///< When the frame was received; microseconds since the Unix epoch.
  std::uint32_t id = 0;        ///< Identifier alone, without any flag bit.
  std::uint8_t interface = 0;  ///< Index of the bus in the daemon's list of interfaces.
  std::uint8_t length = 0;     ///< Bytes of data: 0..8, FD up to 64. Bytes past it are zero.
  bool extended = false;       ///< 29-bit identifier.
  bool remote = false;         ///< Remote request: carries no data, whatever length says.
  bool error = false;          ///< Error report of the controller, not traffic.
  bool fd = false;             ///< CAN FD frame.
  std::array<std::uint8_t, 64> data{};

  /// Classic 11-bit data frame: the only kind the radars send.
  [[nodiscard]] constexpr bool is_classic_data() const {
    return !extended && !remote && !error && !fd;
  }
};

}  // namespace cremed
