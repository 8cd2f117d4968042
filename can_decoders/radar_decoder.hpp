// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "cremed/can_decoders/can_frame.hpp"
#include "cremed/can_decoders/detection.hpp"
#include "cremed/can_decoders/radar_health.hpp"

namespace cremed {

using Payload = std::array<std::uint8_t, 8>;

/// No radar sends more messages for one target.
inline constexpr std::size_t kMaxMessages = 4;

/// What one frame adds to a scan. The messages of a target (ARS408: general and quality; GPR: A and
/// B) are kept as bytes and become a Detection when all are there.
struct ScanPart {
  enum class Kind : std::uint8_t {
    none,    ///< The frame is not part of a scan: another id, a state report, or rejected.
    header,  ///< A new scan begins: `counter` and `target_count` are set.
    target,  ///< Message number `message` of target `slot`.
  };
  Kind kind = Kind::none;
  std::uint8_t message = 0;  ///< From 0; less than ScanFraming::messages.
  std::uint8_t slot = 0;
  std::uint16_t counter = 0;
  std::uint16_t target_count = 0;
  std::int64_t stamp_us = 0;
  Payload payload{};
};

/// All messages of one target, as many as ScanFraming::messages says.
using TargetPayload = std::array<Payload, kMaxMessages>;

/// How a radar family frames its scans.
struct ScanFraming {
  bool has_header = true;  ///< false: every part carries the counter instead.
  std::uint32_t counter_modulus = 65536;
  std::uint16_t slot_count = 256;  ///< Without header: targets in every scan.
  std::uint8_t messages = 1;       ///< Of each target, 1 to kMaxMessages.
};

/// Why frames did not become parts of a scan. Frames of other ids are not counted here.
struct DecoderCounters {
  std::uint64_t frames = 0;          ///< Frames with an id of this radar.
  std::uint64_t state_frames = 0;    ///< Well-formed frames that report state, not targets.
  std::uint64_t wrong_length = 0;    ///< Shorter than the message needs.
  std::uint64_t wrong_kind = 0;      ///< Remote, FD frame on one of this radar's ids.
  std::uint64_t wrong_mode = 0;      ///< Cluster frames for an object radar or the reverse.
  std::uint64_t wrong_slot = 0;      ///< Target number or A/B flag contradicts the identifier.
  std::uint64_t crc_errors = 0;      ///< Wrong checksum, counted under policies count and enforce.
  std::uint64_t counter_errors = 0;  ///< A message's own rolling counter skipped or repeated.
};

/// Turns the frames of one radar into parts of scans. Never throws, allocates or reads past the
/// frame's length; bad input is counted.
class RadarDecoder {
 public:
  virtual ~RadarDecoder() = default;

  /// What the frame adds to a scan; Kind::none for everything else.
  virtual ScanPart decode(const CanFrame& frame) = 0;

  /// The target that its messages describe.
  [[nodiscard]] virtual Detection detection(const TargetPayload& target) const = 0;

  [[nodiscard]] virtual ScanFraming framing() const = 0;

  /// What the radar last reported of itself.
  [[nodiscard]] virtual RadarHealth health() const = 0;

  [[nodiscard]] const DecoderCounters& counters() const { return counters_; }

 protected:
  RadarDecoder() = default;
  RadarDecoder(const RadarDecoder&) = default;
  RadarDecoder& operator=(const RadarDecoder&) = default;

  DecoderCounters counters_;
};

}  // namespace cremed
