// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "cremed/can_decoders/ars408_messages.hpp"
#include "cremed/can_decoders/radar_decoder.hpp"
#include "cremed/can_decoders/radar_settings.hpp"

namespace cremed {

/// The interface document (V1.0, V1.91) describes both: same identifiers, messages and settings.
enum class Ars408Model : std::uint8_t { ars408_21, ars404_21 };

/// Maximum range of an ARS404. Source: a public driver of both sensors expects 190 m in the 0x201
/// of an ARS404 (ContiRadarConfig_200.h, CrossOcean). No public source was found for its field of
/// view; so there is no azimuth limit. The sensor itself marks clusters outside it (InvalidState
/// 7).
inline constexpr double kArs404MaxRangeM = 190.0;

/// The output type of an ARS408 (RadarState OutputTypeCfg: 1 objects, 2 clusters).
enum class Ars408Output : std::uint8_t { clusters, objects };

/// Time by which an ARS408 extrapolates the positions of its clusters
/// (estimator/scan/rotation_lead.hpp). Measured on four turning nuScenes drives with the Doppler of
/// static targets: 0.0413 +- 0.0002 s (front), 0.0380 and 0.0388 +- 0.0003 s (rear). Not used for
/// objects: no measurement.
inline constexpr double kArs408RotationLeadS = 0.040;

/// Less than the period of 0x201, one second.
inline constexpr std::int64_t kArs408ShortestStateGapUs = 400'000;

/// keep_dyn_props that leaves nothing out.
inline constexpr std::uint8_t kEveryDynProp = 0xFF;

struct Ars408Options {
  std::uint8_t sensor_id = 0;  ///< 0..7; every identifier is base + 0x10 * sensor_id.
  Ars408Output output = Ars408Output::clusters;
  /// Bit n set: keep clusters with InvalidState n (table I). Default: 0, 4, 11.
  std::uint32_t keep_invalid_states = (1U << 0U) | (1U << 4U) | (1U << 11U);
  /// Bit n set: keep targets with DynProp n (table D). Default: 1, 3, 5 (stationary).
  std::uint8_t keep_dyn_props = (1U << 1U) | (1U << 3U) | (1U << 5U);
  /// Objects with a smaller ProbOfExist code (table P, 0..7) are rejected. Default: 5, >= 90 %.
  std::uint8_t min_existence_code = 5;
  bool invert_azimuth = false;   ///< Mounted upside down: y and azimuth are positive to the right.
  bool motion_feedback = false;  ///< The daemon sends the estimate to the sensor (0x300, 0x301).
  Ars408Model model = Ars408Model::ars408_21;

  bool operator==(const Ars408Options&) const = default;
};

const RadarFamily& family_of(const Ars408Options& options);

/// One Continental ARS408 or ARS404. A scan is its list of clusters (0x600, 0x701, 0x702) or of
/// objects (0x60A, 0x60B, 0x60C); a target's slot is its id. All other messages of the sensor,
/// including 0x60D and 0x60E, are counted as state.
///
/// A frame is checked in this order: identifier, kind, length, mode. Extended frames, error frames
/// and frames of another sensor are ignored and not counted.
///
/// A 0x201 that names another sensor, or that comes more often than once a second, is from another
/// device with this identifier (a GPR); the state is then unknown. Frames with equal stamps do not
/// come too often.
///
/// The validity of a detection is the first that applies of: no_position, no_noise, invalid_state,
/// moving, low_existence. An object that the sensor has deleted is invalid_state. Four rms codes of
/// 0 are no_noise, not "0.005": recordings contain 0 only in all four codes at once, nearly always
/// on clusters that the sensor calls invalid.
class Ars408Decoder final : public RadarDecoder {
 public:
  explicit Ars408Decoder(const Ars408Options& options) : options_(options) {}

  ScanPart decode(const CanFrame& frame) override;
  [[nodiscard]] Detection detection(const TargetPayload& target) const override;
  [[nodiscard]] ScanFraming framing() const override { return {true, 65536, 256, 2}; }
  [[nodiscard]] RadarHealth health() const override;

  /// The latest 0x201.
  [[nodiscard]] const std::optional<Ars408RadarState>& radar_state() const { return radar_state_; }

 private:
  [[nodiscard]] const Ars408MessageRow* find(const CanFrame& frame) const;
  void note_state(const CanFrame& frame, Ars408Bytes bytes);
  [[nodiscard]] Detection cluster(const TargetPayload& target) const;
  [[nodiscard]] Detection object(const TargetPayload& target) const;
  [[nodiscard]] Detection judged(const Ars408General& target, const Ars408RmsCodes& rms,
                                 bool is_valid, bool exists) const;

  Ars408Options options_;
  std::optional<Ars408RadarState> radar_state_;
  std::optional<std::int64_t> last_state_us_;
};

}  // namespace cremed
