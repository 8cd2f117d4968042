// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include <cremed/status_t.hpp>

#include "daemon/output/radar_status.hpp"

namespace cremed {

/// A counter of Counters: its place in status_t, and its name in the report.
template <typename Counters>
struct CounterRow {
  std::int32_t place;
  std::uint64_t Counters::*counter;
  std::string_view name = {};  ///< Empty: it is no fault.
};

inline constexpr std::array<CounterRow<DecoderCounters>, 8> kDecoderRows{{
    {status_t::COUNTER_FRAMES_OF_THIS_RADAR, &DecoderCounters::frames},
    {status_t::COUNTER_FRAMES_STATE, &DecoderCounters::state_frames},
    {status_t::COUNTER_FRAMES_WRONG_LENGTH, &DecoderCounters::wrong_length, "wrong length"},
    {status_t::COUNTER_FRAMES_WRONG_KIND, &DecoderCounters::wrong_kind, "remote or FD"},
    {status_t::COUNTER_FRAMES_WRONG_MODE, &DecoderCounters::wrong_mode, "wrong mode"},
    {status_t::COUNTER_FRAMES_WRONG_SLOT, &DecoderCounters::wrong_slot, "wrong slot"},
    {status_t::COUNTER_CRC_ERRORS, &DecoderCounters::crc_errors, "CRC errors"},
    {status_t::COUNTER_COUNTER_ERRORS, &DecoderCounters::counter_errors, "counter errors"},
}};

using ScanCounters = AssemblerCounters;
inline constexpr std::array<CounterRow<ScanCounters>, 14> kScanRows{{
    {status_t::COUNTER_SCANS, &ScanCounters::scans},
    {status_t::COUNTER_SCANS_EMPTY, &ScanCounters::empty_scans},
    {status_t::COUNTER_SCANS_INCOMPLETE, &ScanCounters::incomplete_scans, "incomplete"},
    {status_t::COUNTER_SCANS_WITHOUT_HEADER, &ScanCounters::headerless_scans, "without header"},
    {status_t::COUNTER_SCANS_TIMED_OUT, &ScanCounters::timeouts, "timed out"},
    {status_t::COUNTER_SCANS_MISSED, &ScanCounters::missed_scans, "missed"},
    {status_t::COUNTER_SCANS_REPEATED, &ScanCounters::repeated_scans, "repeated"},
    {status_t::COUNTER_PARTS_MISSING, &ScanCounters::missing_parts, "missing parts"},
    {status_t::COUNTER_PARTS_DUPLICATE, &ScanCounters::duplicate_parts, "duplicate parts"},
    {status_t::COUNTER_PARTS_CONFLICTING, &ScanCounters::conflicting_parts, "conflicting parts"},
    {status_t::COUNTER_PARTS_REORDERED, &ScanCounters::reordered_parts, "reordered parts"},
    {status_t::COUNTER_PARTS_EXCESS, &ScanCounters::excess_parts, "excess parts"},
    {status_t::COUNTER_PARTS_ORPHAN, &ScanCounters::orphan_parts, "orphan parts"},
    {status_t::COUNTER_STAMPS_BACKWARDS, &ScanCounters::stamps_backwards, "stamps backwards"},
}};

inline constexpr std::array<CounterRow<SelectionCounters>, 7> kSelectionRows{{
    {status_t::COUNTER_DETECTIONS_USED, &SelectionCounters::used},
    {status_t::COUNTER_DETECTIONS_NO_NOISE, &SelectionCounters::no_noise, "no noise"},
    {status_t::COUNTER_DETECTIONS_INVALID_STATE, &SelectionCounters::invalid_state,
     "invalid state"},
    {status_t::COUNTER_DETECTIONS_MOVING, &SelectionCounters::moving, "moving"},
    {status_t::COUNTER_DETECTIONS_LOW_EXISTENCE, &SelectionCounters::low_existence,
     "low existence"},
    {status_t::COUNTER_DETECTIONS_NO_POSITION, &SelectionCounters::no_position, "no position"},
    {status_t::COUNTER_DETECTIONS_OUTSIDE_LIMITS, &SelectionCounters::outside_limits,
     "outside limits"},
}};

}  // namespace cremed
