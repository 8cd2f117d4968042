// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "cremed/can_decoders/detection.hpp"

namespace cremed {

/// An ARS408 names its targets with one byte, a GPR has 48 slots: no radar here can exceed this.
inline constexpr std::size_t kMaxDetections = 256;

/// Is the scan whole? Only `complete` is everything the radar saw. With missing_parts and
/// dropped_frames the targets that came are sound, others may be missing; otherwise they may be of
/// more than one list.
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
