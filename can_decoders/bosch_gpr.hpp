// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "cremed/can_decoders/radar_decoder.hpp"
#include "cremed/can_decoders/radar_settings.hpp"

namespace cremed {

/// off: not checked. count: counted, frame used if it is a target's. enforce: counted, frame
/// dropped.
enum class CrcPolicy : std::uint8_t { off, count, enforce };

struct BoschGprOptions {
  std::uint32_t base_id = 0x200;  ///< Message A of slot k: base + 2 k, B: base + 2 k + 1.
  std::uint32_t info_id = 0x100;
  CrcPolicy crc_policy = CrcPolicy::count;
  bool invert_azimuth = false;  ///< true: the sensor counts azimuth positive to the right.
  bool invert_doppler = false;  ///< true: the sensor's radial velocity is positive when closing.
  double min_existence = 0.0;   ///< Targets with a smaller pExist (0..0.96875) are rejected.

  bool operator==(const BoschGprOptions&) const = default;
};

const RadarFamily& family_of(const BoschGprOptions& options);

inline constexpr std::uint8_t kBoschGprSlots = 48;
/// Messages per slot.
inline constexpr std::uint32_t kGprTargetIds = 2U * kBoschGprSlots;

/// Message A: the measurement, with the sensor's signs.
struct BoschGprTargetA {
  bool is_a = false;
  /// 0..47; larger values suggest a sister product with the same identifiers.
  std::uint8_t id = 0;
  double range_m = 0.0;
  double radial_velocity_mps = 0.0;
  double power_dbm2 = 0.0;
  double azimuth_rad = 0.0;
  bool measured = false;  ///< The slot holds a target in this scan.
  std::uint8_t counter = 0;
};

/// Message B: quality of the measurement. A standard deviation of 0 means less than half a step.
struct BoschGprTargetB {
  bool is_a = false;
  std::uint8_t id = 0;
  double azimuth_std_rad = 0.0;
  double radial_velocity_std_mps = 0.0;
  double range_std_m = 0.0;
  double existence = 0.0;  ///< 0..0.96875
  double age_s = 0.0;      ///< timeSinceMeas
  std::uint8_t counter = 0;
};

/// Status of the sensor.
struct BoschGprInfo {
  std::uint8_t sensor_type = 0;
  std::int16_t temperature_degc = 0;
  bool blind = false;
  bool software_failure = false;
  bool hardware_failure = false;
  bool can_failure = false;
  bool configuration_failure = false;
  bool diagnostic_mode = false;
  std::uint32_t trouble_code = 0;  ///< 0: none.
  std::uint8_t trouble_order = 0;
  bool not_safe = false;
  std::uint8_t counter = 0;
};

/// SAE J1850: polynomial 0x1D, start 0xFF, result inverted; "123456789" gives 0x4B. The last byte
/// of a message is the checksum of the bytes before it.
std::uint8_t crc8_j1850(std::span<const std::uint8_t> bytes);

/// One Bosch general purpose radar. A scan is 48 slots of two messages, sent with or without a
/// target; each message carries the scan's two-bit counter.
///
/// A frame is checked in this order: identifier, kind, length, checksum, slot.
/// The identifier gives the slot. A frame is counted as wrong_slot and dropped if its A flag
/// contradicts the identifier or its target number is not 0..47. A different number in 0..47 is
/// counted as wrong_slot and the frame used: at least one transmitter sends 0 in all slots.
/// A message whose counter does not follow its last one is counted (counter_errors) and used, so
/// that a lost frame does not cost the next one too. After a dropped frame any counter is accepted.
///
/// The validity of a detection is the first that applies of: empty, no_position, low_existence.
class BoschGprDecoder final : public RadarDecoder {
 public:
  explicit BoschGprDecoder(const BoschGprOptions& options);

  ScanPart decode(const CanFrame& frame) override;
  [[nodiscard]] Detection detection(const TargetPayload& target) const override;
  [[nodiscard]] ScanFraming framing() const override { return {false, 4, kBoschGprSlots, 2}; }
  [[nodiscard]] RadarHealth health() const override;

  /// The latest Info message, for a status report.
  [[nodiscard]] const std::optional<BoschGprInfo>& info() const { return info_; }

 private:
  static constexpr std::size_t kInfoIndex = kGprTargetIds;
  static constexpr std::size_t kForeign = kInfoIndex + 1;
  static constexpr std::uint8_t kAnyCounter = 0xFF;

  [[nodiscard]] std::size_t index_of(const CanFrame& frame) const;
  bool trust(const Payload& payload, std::size_t index);
  bool check_crc(const Payload& payload, std::size_t index);
  bool check_slot(const Payload& payload, std::size_t index);
  void check_counter(std::uint8_t counter, std::size_t index);

  BoschGprOptions options_;
  std::optional<BoschGprInfo> info_;
  std::array<std::uint8_t, kForeign> last_counters_;  ///< By index_of().
};

/// Content of a payload; nothing if that has fewer than eight bytes. Flag, id and checksum are not
/// checked.
template <typename Content>
std::optional<Content> decode_bosch_gpr(std::span<const std::uint8_t> bytes);

}  // namespace cremed
