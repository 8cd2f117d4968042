// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

namespace cremed {

/// One frame of a bus, from any source (socket, log, simulator).
struct CanFrame {
  std::int64_t stamp_us = 0;   ///< Receive time; microseconds since the Unix epoch.
  std::uint32_t id = 0;        ///< Identifier without flag bits.
  std::uint8_t interface = 0;  ///< Index of the bus in the daemon's list of interfaces.
  std::uint8_t length = 0;     ///< Bytes of data: 0..8, FD up to 64. Bytes past it are zero.
  bool extended = false;       ///< 29-bit identifier.
  bool remote = false;         ///< Remote request: carries no data, whatever its length.
  bool error = false;          ///< Error report of the controller.
  bool fd = false;             ///< CAN FD frame.
  std::array<std::uint8_t, 64> data{};

  /// Classic 11-bit data frame: the only kind the radars send.
  [[nodiscard]] constexpr bool is_classic_data() const {
    return !extended && !remote && !error && !fd;
  }
};

}  // namespace cremed
