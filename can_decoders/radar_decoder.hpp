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

/// The most messages per target of any radar family.
inline constexpr std::size_t kMaxMessages = 4;

/// The part of a scan that one frame carries. The messages of a target (ARS408: general and
/// quality; GPR: A and B) are kept as bytes and decoded to a Detection when all have arrived.
struct ScanPart {
  enum class Kind : std::uint8_t {
    none,    ///< Not part of a scan: another id, a state report, or rejected.
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

/// All messages of one target; ScanFraming::messages is their number.
using TargetPayload = std::array<Payload, kMaxMessages>;

/// How a radar family frames its scans.
struct ScanFraming {
  bool has_header = true;  ///< false: every part carries the counter.
  std::uint32_t counter_modulus = 65536;
  std::uint16_t slot_count = 256;  ///< Without header: targets in every scan.
  std::uint8_t messages = 1;       ///< Per target, 1 to kMaxMessages.
};

/// Reasons why frames did not become parts of a scan. Frames with other ids are not counted.
struct DecoderCounters {
  std::uint64_t frames = 0;          ///< Frames with an id of this radar.
  std::uint64_t state_frames = 0;    ///< Well-formed frames that report state, not targets.
  std::uint64_t wrong_length = 0;    ///< Shorter than the message.
  std::uint64_t wrong_kind = 0;      ///< Remote or FD frame with an id of this radar.
  std::uint64_t wrong_mode = 0;      ///< Cluster frames for an object radar or the reverse.
  std::uint64_t wrong_slot = 0;      ///< Target number or A/B flag contradicts the identifier.
  std::uint64_t crc_errors = 0;      ///< Wrong checksum, counted under policies count and enforce.
  std::uint64_t counter_errors = 0;  ///< A message's own rolling counter skipped or repeated.
};

/// Converts the frames of one radar to parts of scans. Never throws, allocates or reads past the
/// frame's length; bad input is counted.
class RadarDecoder {
 public:
  virtual ~RadarDecoder() = default;

  /// The part of a scan in the frame; Kind::none for all other frames.
  virtual ScanPart decode(const CanFrame& frame) = 0;

  /// Decodes the messages of one target.
  [[nodiscard]] virtual Detection detection(const TargetPayload& target) const = 0;

  [[nodiscard]] virtual ScanFraming framing() const = 0;

  /// The radar's latest report about itself.
  [[nodiscard]] virtual RadarHealth health() const = 0;

  [[nodiscard]] const DecoderCounters& counters() const { return counters_; }

 protected:
  RadarDecoder() = default;
  RadarDecoder(const RadarDecoder&) = default;
  RadarDecoder& operator=(const RadarDecoder&) = default;

  /// Counts a frame of this radar; false if it is no data frame of CAN 2.0 with so many bytes.
  bool accept(const CanFrame& frame, std::size_t least_length) {
    ++counters_.frames;
    if (frame.remote || frame.fd) {
      ++counters_.wrong_kind;
      return false;
    }
    if (frame.length < least_length) {
      ++counters_.wrong_length;
      return false;
    }
    return true;
  }

  DecoderCounters counters_;
};

}  // namespace cremed
