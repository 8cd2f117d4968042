// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <bitset>
#include <cstdint>

#include "can_decoders/radar_decoder.hpp"
#include "can_decoders/radar_scan.hpp"

namespace cremed {

struct AssemblerCounters {
  std::uint64_t scans = 0;               ///< Closed scans of any status.
  std::uint64_t incomplete_scans = 0;    ///< Those of them that are not ScanStatus::complete.
  std::uint64_t empty_scans = 0;         ///< Complete scans with no target.
  std::uint64_t timeouts = 0;            ///< Scans closed because no part came for too long.
  std::uint64_t missing_parts = 0;       ///< Announced messages that never came.
  std::uint64_t duplicate_parts = 0;     ///< Same message, same bytes, again: ignored.
  std::uint64_t conflicting_parts = 0;   ///< Same message, other bytes: the scan is not whole.
  std::uint64_t reordered_parts = 0;     ///< Second message of a target before its first: used.
  std::uint64_t excess_parts = 0;        ///< Targets beyond the announced number: dropped.
  std::uint64_t orphan_parts = 0;        ///< Parts while no scan is open: dropped.
  std::uint64_t repeated_scans = 0;      ///< Header with the counter of the last scan: dropped.
  std::uint64_t missed_scans = 0;        ///< Cycles the counter skipped.
  std::uint64_t stamps_backwards = 0;    ///< Stamp earlier than the one before it.
};

/// Collects the parts of one radar into scans, closed by count, counter change, next header or
/// time-out. Usage:
///
///     assembler.add(decoder.decode(frame));
///     while (const RadarScan* scan = assembler.next()) use(*scan);
///
/// At most two scans can be waiting (a header that closes a scan and announces no target).
class ScanAssembler {
 public:
  /// `decoder` must outlive the assembler. An open scan closes as incomplete when `timeout_us`
  /// pass without a part of it.
  ScanAssembler(const RadarDecoder& decoder, std::int64_t timeout_us);

  void add(const ScanPart& part);

  /// Lets time pass: closes the open scan if its last part is older than the time-out.
  void expire(std::int64_t now_us);

  /// The frame source lost frames: the open scan, if any, can no longer be whole.
  void mark_dropped();

  /// No more input: closes the open scan.
  void finish();

  /// The oldest closed scan not yet handed out, or nullptr. Valid until the next call of add,
  /// expire or finish.
  const RadarScan* next();

  [[nodiscard]] const AssemblerCounters& counters() const { return counters_; }
};

}  // namespace cremed
