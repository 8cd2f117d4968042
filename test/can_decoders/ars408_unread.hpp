// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Messages of an ARS408 that the product does not read: config/ars408.dbc has them, and is compared
// with these.

#include <cstdint>
#include <optional>

#include "cremed/can_decoders/ars408_decoded.hpp"
#include "cremed/can_decoders/ars408_layout.hpp"

namespace cremed {
namespace ars408_layout {

namespace extended {
inline constexpr BitField kAx{21, 11};
inline constexpr BitField kAy{28, 9};
inline constexpr BitField kClass{24, 3};
inline constexpr BitField kOrientation{46, 10};
inline constexpr BitField kLength{48, 8};
inline constexpr BitField kWidth{56, 8};
inline constexpr LinearScale kAxScale{1000.0, 100.0};
inline constexpr LinearScale kAyScale{250.0, 100.0};
inline constexpr LinearScale kOrientationScale{450.0, 2.5 * kDegPerRad};
inline constexpr LinearScale kSizeScale{0.0, 5.0};
}  // namespace extended

namespace warning {
inline constexpr BitField kRegions{8, 8};
}  // namespace warning

namespace collision {
inline constexpr std::uint8_t kActive = 1;
inline constexpr BitField kRegions{4, 4};
inline constexpr BitField kMinDetectionTime{8, 8};
inline constexpr BitField kCounter{24, 16};
inline constexpr LinearScale kTimeScale{0.0, 10.0};
inline constexpr BitField kRegionId{5, 3};
inline constexpr BitField kWarningLevel{3, 2};
inline constexpr BitField kX1{19, 13};
inline constexpr BitField kY1{24, 11};
inline constexpr BitField kX2{43, 13};
inline constexpr BitField kY2{48, 11};
inline constexpr BitField kObjectCount{56, 8};
}  // namespace collision

namespace filter_header {
inline constexpr BitField kClusterFilters{3, 5};
inline constexpr BitField kObjectFilters{11, 5};
}  // namespace filter_header

}  // namespace ars408_layout

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

inline std::optional<Ars408ObjectExtended> decode_ars408_object_extended(Ars408Bytes bytes) {
  using namespace ars408_layout::extended;
  return decoded(Ars408Message::object_extended, bytes, [](PayloadBits bits) {
    return Ars408ObjectExtended{.id = bits.get8(ars408_layout::kId),
                                .ax_mps2 = kAxScale(bits.get(kAx)),
                                .ay_mps2 = kAyScale(bits.get(kAy)),
                                .object_class = bits.get8(kClass),
                                .orientation_rad = kOrientationScale(bits.get(kOrientation)),
                                .length_m = kSizeScale(bits.get(kLength)),
                                .width_m = kSizeScale(bits.get(kWidth))};
  });
}

inline std::optional<Ars408ObjectWarning> decode_ars408_object_warning(Ars408Bytes bytes) {
  return decoded(Ars408Message::object_warning, bytes, [](PayloadBits bits) {
    return Ars408ObjectWarning{.id = bits.get8(ars408_layout::kId),
                               .regions = bits.get8(ars408_layout::warning::kRegions)};
  });
}

inline std::optional<Ars408FilterHeader> decode_ars408_filter_header(Ars408Bytes bytes) {
  return decoded(Ars408Message::filter_header, bytes, [](PayloadBits bits) {
    return Ars408FilterHeader{
        .cluster_filters = bits.get8(ars408_layout::filter_header::kClusterFilters),
        .object_filters = bits.get8(ars408_layout::filter_header::kObjectFilters)};
  });
}

inline std::optional<Ars408CollisionState> decode_ars408_collision_state(Ars408Bytes bytes) {
  using namespace ars408_layout::collision;
  return decoded(Ars408Message::collision_state, bytes, [](PayloadBits bits) {
    return Ars408CollisionState{.active = bits.flag(kActive),
                                .regions = bits.get8(kRegions),
                                .min_detection_time_s = kTimeScale(bits.get(kMinDetectionTime)),
                                .counter = bits.get16(kCounter)};
  });
}

inline std::optional<Ars408RegionState> decode_ars408_region_state(Ars408Bytes bytes) {
  using namespace ars408_layout::collision;
  return decoded(Ars408Message::region_state, bytes, [](PayloadBits bits) {
    return Ars408RegionState{.region_id = bits.get8(kRegionId),
                             .warning_level = bits.get8(kWarningLevel),
                             .x1_m = ars408_layout::general::kXScale(bits.get(kX1)),
                             .y1_m = ars408_layout::general::kObjectYScale(bits.get(kY1)),
                             .x2_m = ars408_layout::general::kXScale(bits.get(kX2)),
                             .y2_m = ars408_layout::general::kObjectYScale(bits.get(kY2)),
                             .object_count = bits.get8(kObjectCount)};
  });
}

}  // namespace cremed
