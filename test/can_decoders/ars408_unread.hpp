// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Messages of an ARS408 that the product does not read: config/ars408.dbc has them, and is compared
// with these.

#include <cstdint>
#include <optional>

#include "cremed/can_decoders/ars408_signals.hpp"

namespace cremed {
/// 0x60D.
struct Ars408ObjectExtended {
  std::uint8_t id = 0;
  double ax_mps2 = 0.0;
  double ay_mps2 = 0.0;
  std::uint8_t object_class = 0;  ///< 0 point, 1 car, 2 truck, 3 pedestrian, 4 motorcycle,
                                  ///< 5 bicycle, 6 wide, 7 reserved.
  double orientation_rad = 0.0;
  double length_m = 0.0;
  double width_m = 0.0;
};

/// 0x60E.
struct Ars408ObjectWarning {
  std::uint8_t id = 0;
  std::uint8_t regions = 0;  ///< Bit n: the object is in collision region n.
};

/// 0x203: the number of 0x204 that follow.
struct Ars408FilterHeader {
  std::uint8_t cluster_filters = 0;
  std::uint8_t object_filters = 0;
};

/// 0x408.
struct Ars408CollisionState {
  bool active = false;
  std::uint8_t regions = 0;
  double min_detection_time_s = 0.0;
  std::uint16_t counter = 0;
};

/// 0x402: one collision region, by two opposite corners.
struct Ars408RegionState {
  std::uint8_t region_id = 0;
  std::uint8_t warning_level = 0;
  double x1_m = 0.0;
  double y1_m = 0.0;
  double x2_m = 0.0;
  double y2_m = 0.0;
  std::uint8_t object_count = 0;
};

template <typename Signal>
void signals(const Signal& signal, Ars408ObjectExtended& m) {
  signal({0, 8}, m.id);
  signal({21, 11}, {1000.0, 100.0}, m.ax_mps2);
  signal({28, 9}, {250.0, 100.0}, m.ay_mps2);
  signal({24, 3}, m.object_class);
  signal({46, 10}, {450.0, 2.5 * ars408_signals::kDegPerRad}, m.orientation_rad);
  signal({48, 8}, {0.0, 5.0}, m.length_m);
  signal({56, 8}, {0.0, 5.0}, m.width_m);
}

template <typename Signal>
void signals(const Signal& signal, Ars408ObjectWarning& m) {
  signal({0, 8}, m.id);
  signal({8, 8}, m.regions);
}

template <typename Signal>
void signals(const Signal& signal, Ars408FilterHeader& m) {
  signal({3, 5}, m.cluster_filters);
  signal({11, 5}, m.object_filters);
}

template <typename Signal>
void signals(const Signal& signal, Ars408CollisionState& m) {
  signal({1, 1}, m.active);
  signal({4, 4}, m.regions);
  signal({8, 8}, {0.0, 10.0}, m.min_detection_time_s);
  signal({24, 16}, m.counter);
}

template <typename Signal>
void signals(const Signal& signal, Ars408RegionState& m) {
  signal({5, 3}, m.region_id);
  signal({3, 2}, m.warning_level);
  signal({19, 13}, {2500.0, 5.0}, m.x1_m);
  signal({24, 11}, {1023.0, 5.0}, m.y1_m);
  signal({43, 13}, {2500.0, 5.0}, m.x2_m);
  signal({48, 11}, {1023.0, 5.0}, m.y2_m);
  signal({56, 8}, m.object_count);
}

inline std::optional<Ars408ObjectExtended> decode_ars408_object_extended(Ars408Bytes bytes) {
  return ars408_signals::decoded<Ars408ObjectExtended>(Ars408Message::object_extended, bytes);
}

inline std::optional<Ars408ObjectWarning> decode_ars408_object_warning(Ars408Bytes bytes) {
  return ars408_signals::decoded<Ars408ObjectWarning>(Ars408Message::object_warning, bytes);
}

inline std::optional<Ars408FilterHeader> decode_ars408_filter_header(Ars408Bytes bytes) {
  return ars408_signals::decoded<Ars408FilterHeader>(Ars408Message::filter_header, bytes);
}

inline std::optional<Ars408CollisionState> decode_ars408_collision_state(Ars408Bytes bytes) {
  return ars408_signals::decoded<Ars408CollisionState>(Ars408Message::collision_state, bytes);
}

inline std::optional<Ars408RegionState> decode_ars408_region_state(Ars408Bytes bytes) {
  return ars408_signals::decoded<Ars408RegionState>(Ars408Message::region_state, bytes);
}

}  // namespace cremed
