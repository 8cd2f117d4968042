// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/can_decoders/ars408.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "cremed/can_decoders/ars408_signals.hpp"

namespace cremed {
namespace {

constexpr double kMinRangeM = 0.01;

/// Standard deviations of a target's position and velocity.
struct CartesianStd {
  double x_m;
  double y_m;
  double vx_mps;
  double vy_mps;
};

std::optional<CartesianStd> cartesian_std(const Ars408RmsCodes& codes) {
  const auto x = ars408_std(codes.x);
  const auto y = ars408_std(codes.y);
  const auto vx = ars408_std(codes.vx);
  const auto vy = ars408_std(codes.vy);
  const bool no_quality = (codes.x | codes.y | codes.vx | codes.vy) == 0;
  if (no_quality || !x || !y || !vx || !vy) {
    return std::nullopt;
  }
  return CartesianStd{*x, *y, *vx, *vy};
}

Motion motion_of(Ars408DynProp dyn_prop) {
  switch (dyn_prop) {
    case Ars408DynProp::moving:
    case Ars408DynProp::oncoming:
    case Ars408DynProp::crossing_moving:
      return Motion::moving;
    case Ars408DynProp::stationary:
    case Ars408DynProp::stationary_candidate:
    case Ars408DynProp::crossing_stationary:
    case Ars408DynProp::stopped:
      return Motion::stationary;
    case Ars408DynProp::unknown:
      break;
  }
  return Motion::unknown;
}

/// First order, the four inputs independent. Position errors do not enter the Doppler error: the
/// sensor measures Doppler along the true line of sight and derives the velocity from it. On
/// nuScenes the Doppler scatters by 0.11 m/s, independent of the azimuth noise.
void set_noise(Detection& detection, const Ars408General& target, const CartesianStd& std) {
  const double cosine = target.x_m / detection.range_m;
  const double sine = target.y_m / detection.range_m;
  detection.range_std_m = std::hypot(cosine * std.x_m, sine * std.y_m);
  detection.azimuth_std_rad = std::hypot(sine * std.x_m, cosine * std.y_m) / detection.range_m;
  detection.doppler_std_mps = std::hypot(cosine * std.vx_mps, sine * std.vy_mps);
}

/// The target as seen by a sensor that is mounted upright.
Ars408General upright(Ars408General target) {
  target.y_m = -target.y_m;
  target.vy_mps = -target.vy_mps;
  return target;
}

/// Sets every field but the sensor's own judgement; validity is usable, no_position or no_noise.
Detection polar(const Ars408General& target, const Ars408RmsCodes& rms) {
  Detection detection{.rcs_dbm2 = target.rcs_dbm2,
                      .id = target.id,
                      .motion = motion_of(target.dyn_prop),
                      .validity = Validity::no_position};
  detection.range_m = std::hypot(target.x_m, target.y_m);
  if (detection.range_m < kMinRangeM) {
    return detection;
  }
  detection.azimuth_rad = std::atan2(target.y_m, target.x_m);
  detection.doppler_mps =
      (target.x_m * target.vx_mps + target.y_m * target.vy_mps) / detection.range_m;
  detection.across_mps =
      (target.x_m * target.vy_mps - target.y_m * target.vx_mps) / detection.range_m;
  detection.validity = Validity::no_noise;
  if (const auto std = cartesian_std(rms)) {
    set_noise(detection, target, *std);
    detection.validity = Validity::usable;
  }
  return detection;
}

template <class Code>
bool keeps(std::uint32_t mask, Code code) {
  return ((mask >> static_cast<unsigned>(code)) & 1U) != 0;
}

bool is_deleted(Ars408MeasurementState state) {
  return state == Ars408MeasurementState::deleted ||
         state == Ars408MeasurementState::deleted_for_merge;
}

ScanPart header(std::uint16_t counter, unsigned target_count) {
  return {.kind = ScanPart::Kind::header,
          .counter = counter,
          .target_count = static_cast<std::uint16_t>(target_count)};
}

// `bytes` must end with the layout: the bytes after it are undefined and would break the duplicate
// check.
ScanPart target_part(std::uint8_t message, Ars408Bytes bytes) {
  ScanPart part{.kind = ScanPart::Kind::target, .message = message, .slot = bytes[0]};
  std::copy(bytes.begin(), bytes.end(), part.payload.begin());
  return part;
}

/// `bytes` must have the row's length at least.
ScanPart scan_part(const Ars408MessageRow& row, Ars408Bytes bytes) {
  switch (row.message) {
    case Ars408Message::cluster_status: {
      const auto status = decode_ars408<Ars408ClusterStatus>(bytes);
      return header(status->counter, unsigned{status->near_count} + status->far_count);
    }
    case Ars408Message::object_status: {
      const auto status = decode_ars408<Ars408ObjectStatus>(bytes);
      return header(status->counter, status->count);
    }
    case Ars408Message::cluster_general:
    case Ars408Message::object_general:
      return target_part(0, bytes.first(row.length));
    case Ars408Message::cluster_quality:
    case Ars408Message::object_quality:
      return target_part(1, bytes.first(row.length));
    default:
      return {};
  }
}

RadarHealth::Output output_of(std::uint8_t code) {
  constexpr std::array kOutputs{RadarHealth::Output::none, RadarHealth::Output::objects,
                                RadarHealth::Output::clusters};
  return code < kOutputs.size() ? kOutputs[code] : RadarHealth::Output::unknown;
}

}  // namespace

const Ars408MessageRow* Ars408Decoder::find(const CanFrame& frame) const {
  if (frame.extended || frame.error || ars408_sensor_id(frame.id) != options_.sensor_id) {
    return nullptr;
  }
  const std::uint32_t base = ars408_base_id(frame.id);
  const auto* row = std::ranges::find_if(kArs408Messages, [base](const Ars408MessageRow& r) {
    return static_cast<std::uint32_t>(r.message) == base;
  });
  return row == kArs408Messages.end() ? nullptr : row;
}

ScanPart Ars408Decoder::decode(const CanFrame& frame) {
  const auto other_subject =
      options_.output == Ars408Output::clusters ? Ars408Subject::objects : Ars408Subject::clusters;
  const Ars408MessageRow* row = find(frame);
  if (row == nullptr || !accept(frame, row->length)) {
    return {};
  }
  if (row->subject == other_subject) {
    ++counters_.wrong_mode;
    return {};
  }
  const auto bytes = std::span(frame.data).first(std::min<std::size_t>(frame.length, 8));
  ScanPart part = scan_part(*row, bytes);
  part.stamp_us = frame.stamp_us;
  counters_.state_frames += part.kind == ScanPart::Kind::none ? 1 : 0;
  if (row->message == Ars408Message::radar_state) {
    note_state(frame, bytes);
  }
  return part;
}

void Ars408Decoder::note_state(const CanFrame& frame, Ars408Bytes bytes) {
  const auto state = decode_ars408<Ars408RadarState>(bytes);
  const std::int64_t gap_us = frame.stamp_us - last_state_us_.value_or(frame.stamp_us);
  const bool is_own = state && state->sensor_id == options_.sensor_id &&
                      (gap_us <= 0 || gap_us >= kArs408ShortestStateGapUs);
  last_state_us_ = frame.stamp_us;
  radar_state_ = is_own ? state : std::nullopt;
  counters_.wrong_slot += is_own ? 0 : 1;
}

RadarHealth Ars408Decoder::health() const {
  if (!radar_state_) {
    return {};
  }
  const Ars408RadarState& state = *radar_state_;
  return {.is_known = true,
          .faults = (state.persistent_error ? RadarHealth::persistent_error : 0U) |
                    (state.temporary_error ? RadarHealth::temporary_error : 0U) |
                    (state.temperature_error ? RadarHealth::temperature_error : 0U) |
                    (state.voltage_error ? RadarHealth::voltage_error : 0U) |
                    (state.interference ? RadarHealth::interference : 0U) |
                    (state.speed_missing ? RadarHealth::speed_missing : 0U) |
                    (state.yaw_rate_missing ? RadarHealth::yaw_rate_missing : 0U),
          .output = output_of(state.output_code),
          .sends_quality = state.sends_quality,
          .max_distance_m = state.max_distance_m};
}

Detection Ars408Decoder::detection(const TargetPayload& target) const {
  return options_.output == Ars408Output::clusters ? cluster(target) : object(target);
}

Detection Ars408Decoder::cluster(const TargetPayload& target) const {
  const auto quality = decode_ars408<Ars408ClusterQuality>(target[1]);
  return judged(*decode_ars408<Ars408Cluster>(target[0]), quality->rms,
                keeps(options_.keep_invalid_states, quality->invalid_state), true);
}

Detection Ars408Decoder::object(const TargetPayload& target) const {
  const auto quality = decode_ars408<Ars408ObjectQuality>(target[1]);
  return judged(*decode_ars408<Ars408Object>(target[0]), quality->rms,
                !is_deleted(quality->measurement_state),
                quality->existence_code >= options_.min_existence_code);
}

Detection Ars408Decoder::judged(const Ars408General& target, const Ars408RmsCodes& rms,
                                bool is_valid, bool exists) const {
  Detection detection = polar(options_.invert_azimuth ? upright(target) : target, rms);
  if (detection.validity != Validity::usable) {
    return detection;
  }
  if (!is_valid) {
    detection.validity = Validity::invalid_state;
  } else if (!keeps(options_.keep_dyn_props, target.dyn_prop)) {
    detection.validity = Validity::moving;
  } else if (!exists) {
    detection.validity = Validity::low_existence;
  }
  return detection;
}

}  // namespace cremed
