// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "cremed/can_decoders/ars408_tables.hpp"

namespace cremed {

/// Every message of an ARS408, by its identifier for sensor 0; sensor n adds 0x10 * n.
enum class Ars408Message : std::uint16_t {
  radar_state = 0x201,
  filter_header = 0x203,
  filter_state = 0x204,
  region_state = 0x402,
  collision_state = 0x408,
  cluster_status = 0x600,
  object_status = 0x60A,
  object_general = 0x60B,
  object_quality = 0x60C,
  object_extended = 0x60D,
  object_warning = 0x60E,
  version = 0x700,
  cluster_general = 0x701,
  cluster_quality = 0x702,
};

/// Converts the identifier of sensor 0 to that of sensor 0..7, and back.
constexpr std::uint32_t ars408_id(std::uint32_t base_id, std::uint32_t sensor_id) {
  return base_id + 0x10U * sensor_id;
}
constexpr std::uint32_t ars408_base_id(std::uint32_t id) { return id & ~0x70U; }
constexpr std::uint8_t ars408_sensor_id(std::uint32_t id) {
  return static_cast<std::uint8_t>((id & 0x70U) >> 4U);
}

/// The subject of a message: the sensor itself or one of the two kinds of target list.
enum class Ars408Subject : std::uint8_t { sensor, clusters, objects };

struct Ars408MessageRow {
  Ars408Message message;
  std::uint8_t length;  ///< Bytes with signals; a frame may be longer.
  Ars408Subject subject;
};

inline constexpr std::array<Ars408MessageRow, 14> kArs408Messages{{
    {Ars408Message::radar_state, 8, Ars408Subject::sensor},
    {Ars408Message::filter_header, 2, Ars408Subject::sensor},
    {Ars408Message::filter_state, 5, Ars408Subject::sensor},
    {Ars408Message::region_state, 8, Ars408Subject::sensor},
    {Ars408Message::collision_state, 4, Ars408Subject::sensor},
    {Ars408Message::cluster_status, 5, Ars408Subject::clusters},
    {Ars408Message::object_status, 4, Ars408Subject::objects},
    {Ars408Message::object_general, 8, Ars408Subject::objects},
    {Ars408Message::object_quality, 7, Ars408Subject::objects},
    {Ars408Message::object_extended, 8, Ars408Subject::objects},
    {Ars408Message::object_warning, 2, Ars408Subject::objects},  // Sent with 4 bytes.
    {Ars408Message::version, 3, Ars408Subject::sensor},  // The fourth byte holds flags only.
    {Ars408Message::cluster_general, 8, Ars408Subject::clusters},
    {Ars408Message::cluster_quality, 5, Ars408Subject::clusters},
}};

/// 0x600, header of a cluster list.
struct Ars408ClusterStatus {
  static constexpr auto kMessage = Ars408Message::cluster_status;

  std::uint8_t near_count = 0;
  std::uint8_t far_count = 0;
  std::uint16_t counter = 0;
  std::uint8_t interface_version = 0;
};

/// 0x60A, header of an object list.
struct Ars408ObjectStatus {
  static constexpr auto kMessage = Ars408Message::object_status;

  std::uint8_t count = 0;
  std::uint16_t counter = 0;
  std::uint8_t interface_version = 0;
};

/// Cluster or object: a target relative to the sensor, x forward, y left; negative vx is closing.
struct Ars408General {
  std::uint8_t id = 0;
  double x_m = 0.0;
  double y_m = 0.0;
  double vx_mps = 0.0;
  double vy_mps = 0.0;
  Ars408DynProp dyn_prop = Ars408DynProp::unknown;
  double rcs_dbm2 = 0.0;
};

/// 0x701.
struct Ars408Cluster : Ars408General {
  static constexpr auto kMessage = Ars408Message::cluster_general;
};

/// 0x60B.
struct Ars408Object : Ars408General {
  static constexpr auto kMessage = Ars408Message::object_general;
};

/// Codes of table R, for ars408_rms().
struct Ars408RmsCodes {
  std::uint8_t x = 0;
  std::uint8_t y = 0;
  std::uint8_t vx = 0;
  std::uint8_t vy = 0;
};

/// 0x702.
struct Ars408ClusterQuality {
  static constexpr auto kMessage = Ars408Message::cluster_quality;

  std::uint8_t id = 0;
  Ars408RmsCodes rms;
  std::uint8_t false_alarm_code = 0;  ///< Pdh0, table P: high is bad.
  Ars408InvalidState invalid_state = Ars408InvalidState::valid;
  Ars408Ambiguity ambiguity = Ars408Ambiguity::invalid;
};

/// 0x60C.
struct Ars408ObjectQuality {
  static constexpr auto kMessage = Ars408Message::object_quality;

  std::uint8_t id = 0;
  Ars408RmsCodes rms;
  std::uint8_t ax_rms_code = 0;           ///< Table R.
  std::uint8_t ay_rms_code = 0;           ///< Table R.
  std::uint8_t orientation_rms_code = 0;  ///< Table RA.
  std::uint8_t existence_code = 0;        ///< Table P: high is good.
  Ars408MeasurementState measurement_state = Ars408MeasurementState::deleted;
};

/// 0x201, once a second: settings and faults of the sensor.
struct Ars408RadarState {
  static constexpr auto kMessage = Ars408Message::radar_state;

  bool nvm_read = false;     ///< Configuration was read at start-up.
  bool nvm_written = false;  ///< Configuration was stored since the last 0x200.
  double max_distance_m = 0.0;
  bool persistent_error = false;
  bool interference = false;
  bool temperature_error = false;
  bool temporary_error = false;
  bool voltage_error = false;
  std::uint8_t power_code = 0;  ///< 0 standard, 1 -3 dB, 2 -6 dB, 3 -9 dB.
  std::uint8_t sort_code = 0;   ///< 0 none, 1 range, 2 radar cross section.
  std::uint8_t sensor_id = 0;
  bool speed_missing = false;     ///< No 0x300 received: DynProp is wrong while driving.
  bool yaw_rate_missing = false;  ///< No 0x301 received.
  bool sends_extended = false;    ///< 0x60D.
  bool sends_quality = false;     ///< 0x702 or 0x60C; without them no scan is complete.
  std::uint8_t output_code = 0;   ///< 0 none, 1 objects, 2 clusters.
  bool relay_control = false;
  std::uint8_t rcs_threshold_code = 0;  ///< 0 standard, 1 high sensitivity.
};

/// 0x700.
struct Ars408Version {
  static constexpr auto kMessage = Ars408Message::version;

  std::uint8_t major_release = 0;
  std::uint8_t minor_release = 0;
  std::uint8_t patch_level = 0;
  bool extended_range = false;
  bool power_restricted = false;  ///< The country code demands less power.
};

/// The quantity that a filter limits, and its unit. The sources disagree on the crossing direction
/// of 11 and 13.
enum class Ars408Criterion : std::uint8_t {
  target_count,
  range_m,
  azimuth_rad,
  oncoming_radial_speed_mps,
  departing_radial_speed_mps,
  rcs_dbm2,
  lifetime_s,
  size_m2,
  existence_code,
  y_m,
  x_m,
  crossing_speed_a_mps,
  oncoming_speed_mps,
  crossing_speed_b_mps,
  departing_speed_mps,
  class_bits,
};

/// 0x204.
struct Ars408FilterState {
  static constexpr auto kMessage = Ars408Message::filter_state;

  bool for_objects = false;
  bool active = false;
  Ars408Criterion criterion = Ars408Criterion::target_count;
  double min = 0.0;  ///< In the unit of the criterion.
  double max = 0.0;
};

using Ars408Bytes = std::span<const std::uint8_t>;

/// Content of a payload; nothing if that has fewer bytes than kArs408Messages demands.
template <typename Content>
std::optional<Content> decode_ars408(Ars408Bytes bytes);

}  // namespace cremed
