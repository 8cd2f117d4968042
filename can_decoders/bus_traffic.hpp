// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "cremed/can_decoders/can_frame.hpp"
#include "cremed/can_decoders/id_set.hpp"
#include "cremed/can_decoders/radar_decoder.hpp"

namespace cremed {

/// Statistics of one identifier.
struct IdTraffic {
  std::uint64_t frames = 0;
  std::int64_t last_us = 0;  ///< Stamp of the last frame.
  /// Shortest time between two frames with different stamps.
  std::int64_t shortest_gap_us = std::numeric_limits<std::int64_t>::max();
  std::uint8_t length = 0;  ///< Of the last frame.
  Payload payload{};        ///< Of the last frame.
};

/// The classic data frames of one bus, by identifier, from which radars are recognised.
struct BusTraffic {
  std::array<IdTraffic, 0x800> ids{};

  /// Ignores frames of other kinds.
  void add(const CanFrame& frame);

  /// The identifiers seen.
  [[nodiscard]] IdSet seen() const;
};

}  // namespace cremed
