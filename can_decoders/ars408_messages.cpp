// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/can_decoders/ars408_messages.hpp"

#include "cremed/can_decoders/ars408_decoded.hpp"
#include "cremed/can_decoders/ars408_layout.hpp"

namespace cremed {
namespace {

namespace layout = ars408_layout;
using layout::kId;

Ars408General general_of(PayloadBits bits, double y_m) {
  using namespace layout::general;
  return {.id = bits.get8(kId),
          .x_m = kXScale(bits.get(kX)),
          .y_m = y_m,
          .vx_mps = kVxScale(bits.get(kVx)),
          .vy_mps = kVyScale(bits.get(kVy)),
          .dyn_prop = Ars408DynProp{bits.get8(kDynProp)},
          .rcs_dbm2 = kRcsScale(bits.get(kRcs))};
}

Ars408RmsCodes rms_of(PayloadBits bits) {
  using namespace layout::quality;
  return {.x = bits.get8(kXRms),
          .y = bits.get8(kYRms),
          .vx = bits.get8(kVxRms),
          .vy = bits.get8(kVyRms)};
}

}  // namespace

std::optional<Ars408ClusterStatus> decode_ars408_cluster_status(Ars408Bytes bytes) {
  return decoded(Ars408Message::cluster_status, bytes, [](PayloadBits bits) {
    return Ars408ClusterStatus{.near_count = bits.get8(layout::status::kNearCount),
                               .far_count = bits.get8(layout::status::kFarCount),
                               .counter = bits.get16(layout::status::kClusterCounter),
                               .interface_version = bits.get8(layout::status::kClusterInterface)};
  });
}

std::optional<Ars408ObjectStatus> decode_ars408_object_status(Ars408Bytes bytes) {
  return decoded(Ars408Message::object_status, bytes, [](PayloadBits bits) {
    return Ars408ObjectStatus{.count = bits.get8(layout::status::kObjectCount),
                              .counter = bits.get16(layout::status::kObjectCounter),
                              .interface_version = bits.get8(layout::status::kObjectInterface)};
  });
}

std::optional<Ars408General> decode_ars408_cluster_general(Ars408Bytes bytes) {
  return decoded(Ars408Message::cluster_general, bytes, [](PayloadBits bits) {
    return general_of(bits, layout::general::kClusterYScale(bits.get(layout::general::kClusterY)));
  });
}

std::optional<Ars408General> decode_ars408_object_general(Ars408Bytes bytes) {
  return decoded(Ars408Message::object_general, bytes, [](PayloadBits bits) {
    return general_of(bits, layout::general::kObjectYScale(bits.get(layout::general::kObjectY)));
  });
}

std::optional<Ars408ClusterQuality> decode_ars408_cluster_quality(Ars408Bytes bytes) {
  return decoded(Ars408Message::cluster_quality, bytes, [](PayloadBits bits) {
    return Ars408ClusterQuality{
        .id = bits.get8(kId),
        .rms = rms_of(bits),
        .false_alarm_code = bits.get8(layout::quality::kFalseAlarm),
        .invalid_state = Ars408InvalidState{bits.get8(layout::quality::kInvalidState)},
        .ambiguity = Ars408Ambiguity{bits.get8(layout::quality::kAmbiguity)}};
  });
}

std::optional<Ars408ObjectQuality> decode_ars408_object_quality(Ars408Bytes bytes) {
  return decoded(Ars408Message::object_quality, bytes, [](PayloadBits bits) {
    return Ars408ObjectQuality{
        .id = bits.get8(kId),
        .rms = rms_of(bits),
        .ax_rms_code = bits.get8(layout::quality::kAxRms),
        .ay_rms_code = bits.get8(layout::quality::kAyRms),
        .orientation_rms_code = bits.get8(layout::quality::kOrientationRms),
        .existence_code = bits.get8(layout::quality::kExistence),
        .measurement_state = Ars408MeasurementState{bits.get8(layout::quality::kMeasurementState)}};
  });
}

std::optional<Ars408RadarState> decode_ars408_radar_state(Ars408Bytes bytes) {
  using namespace layout::state;
  return decoded(Ars408Message::radar_state, bytes, [](PayloadBits bits) {
    return Ars408RadarState{.nvm_read = bits.flag(kNvmRead),
                            .nvm_written = bits.flag(kNvmWritten),
                            .max_distance_m = kMaxDistanceScale(bits.get(kMaxDistance)),
                            .persistent_error = bits.flag(kPersistentError),
                            .interference = bits.flag(kInterference),
                            .temperature_error = bits.flag(kTemperatureError),
                            .temporary_error = bits.flag(kTemporaryError),
                            .voltage_error = bits.flag(kVoltageError),
                            .power_code = bits.get8(kPower),
                            .sort_code = bits.get8(kSort),
                            .sensor_id = bits.get8(kSensorId),
                            .speed_missing = bits.flag(kSpeedMissing),
                            .yaw_rate_missing = bits.flag(kYawRateMissing),
                            .sends_extended = bits.flag(kSendsExtended),
                            .sends_quality = bits.flag(kSendsQuality),
                            .output_code = bits.get8(kOutput),
                            .relay_control = bits.flag(kRelayControl),
                            .rcs_threshold_code = bits.get8(kRcsThreshold)};
  });
}

std::optional<Ars408Version> decode_ars408_version(Ars408Bytes bytes) {
  return decoded(Ars408Message::version, bytes, [](PayloadBits bits) {
    return Ars408Version{.major_release = bits.get8(layout::version::kMajor),
                         .minor_release = bits.get8(layout::version::kMinor),
                         .patch_level = bits.get8(layout::version::kPatch),
                         .extended_range = bits.flag(layout::version::kExtendedRange),
                         .power_restricted = bits.flag(layout::version::kPowerRestricted)};
  });
}

std::optional<Ars408FilterState> decode_ars408_filter_state(Ars408Bytes bytes) {
  using namespace layout::filter;
  return decoded(Ars408Message::filter_state, bytes, [](PayloadBits bits) {
    const std::uint8_t index = bits.get8(kIndex);
    const Limits& limits = kLimits[index];
    return Ars408FilterState{.for_objects = bits.flag(kForObjects),
                             .active = bits.flag(kActive),
                             .criterion = Ars408Criterion{index},
                             .min = limits.scale(bits.get({kMin, limits.length})),
                             .max = limits.scale(bits.get({kMax, limits.length}))};
  });
}

}  // namespace cremed
