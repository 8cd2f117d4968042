// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "cremed/can_decoders/detection.hpp"

namespace cremed {

/// The target id of an ARS408 has one byte; a GPR has 48 slots.
inline constexpr std::size_t kMaxDetections = 256;

/// Only `complete` scans hold everything the radar saw. With missing_parts and dropped_frames the
/// targets present are sound, others may be missing; with the rest, targets of more than one list
/// may be mixed.
enum class ScanStatus : std::uint8_t {
  complete,           ///< Every announced target arrived with all its parts.
  missing_parts,      ///< Closed (next scan, time-out, end of input) before every part arrived.
  conflicting_parts,  ///< Parts contradict each other or the header: more than one list mixed.
  over_capacity,      ///< The header announced more than kMaxDetections targets.
  dropped_frames,     ///< The frame source reported lost frames while the scan was open.
};

/// One measurement cycle of one radar.
struct RadarScan {
  std::int64_t stamp_us = 0;  ///< Stamp of the header (GPR: of the first frame).
  std::uint16_t counter = 0;  ///< The sensor's cycle counter.
  ScanStatus status = ScanStatus::complete;
  std::uint16_t announced = 0;  ///< Targets the header announced (GPR: slots, always 48).
  std::uint16_t count = 0;      ///< Valid entries in `detections`, in order of arrival.
  std::array<Detection, kMaxDetections> detections{};
};

}  // namespace cremed
