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

/// What one identifier carried.
struct IdTraffic {
  std::uint64_t frames = 0;
  std::int64_t last_us = 0;  ///< Stamp of the last frame.
  /// Between two frames; of frames with one stamp nothing is known of how often they come.
  std::int64_t shortest_gap_us = std::numeric_limits<std::int64_t>::max();
  std::uint8_t length = 0;  ///< Of the last frame.
  Payload payload{};        ///< Of the last frame.
};

/// The classic data frames of one bus, by identifier: what radars are recognised by.
struct BusTraffic {
  std::array<IdTraffic, 0x800> ids{};

  /// Frames of other kinds are left out.
  void add(const CanFrame& frame);

  /// Identifiers of which a frame came.
  [[nodiscard]] IdSet seen() const;
};

}  // namespace cremed
