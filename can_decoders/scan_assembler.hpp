// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "cremed/can_decoders/radar_decoder.hpp"
#include "cremed/can_decoders/radar_scan.hpp"

namespace cremed {

struct AssemblerCounters {
  std::uint64_t scans = 0;              ///< Closed scans of any status.
  std::uint64_t incomplete_scans = 0;   ///< Those of them that are not ScanStatus::complete.
  std::uint64_t empty_scans = 0;        ///< Complete scans with no target.
  std::uint64_t timeouts = 0;           ///< Scans closed because no part came within the time-out.
  std::uint64_t missing_parts = 0;      ///< Announced messages that never came.
  std::uint64_t duplicate_parts = 0;    ///< Same message, same bytes: ignored.
  std::uint64_t conflicting_parts = 0;  ///< Same message, other bytes: the scan is not complete.
  std::uint64_t reordered_parts = 0;    ///< Later message of a target before an earlier one: used.
  std::uint64_t excess_parts = 0;       ///< Targets beyond the announced number: dropped.
  std::uint64_t orphan_parts = 0;       ///< Parts while no scan is open: dropped.
  std::uint64_t repeated_scans = 0;     ///< The last list again, by counter and bytes: dropped.
  std::uint64_t missed_scans = 0;       ///< Cycles the counter skipped.
  std::uint64_t stamps_backwards = 0;   ///< Stamp earlier than the one before it.
  std::uint64_t headerless_scans = 0;   ///< Scans whose header was lost; all of them incomplete.

  bool operator==(const AssemblerCounters&) const = default;
};

/// Collects the parts of one radar into scans. A scan is closed by its count, a counter change, the
/// next header or the time-out. Usage:
///
///     assembler.add(decoder.decode(frame));
///     while (const RadarScan* scan = assembler.next()) use(*scan);
///
/// At most two scans can be waiting (a header that closes a scan and announces no target); a third
/// overwrites the oldest.
///
/// An incomplete scan has the first status that applies of: over_capacity, conflicting_parts,
/// dropped_frames, missing_parts. Whatever the status, a scan holds the targets whose messages have
/// all arrived, in the order of their first messages, without empty slots.
///
/// With header: a repeated header of the open scan is a duplicate, or a conflict if it announces
/// another number. The header of the last closed scan closes the open scan. A header in the middle
/// of a list whose counter does not continue the last is damaged: a conflict.
///
/// A lost header does not lose the scan. A new scan begins with the first message of one of the
/// first four targets, after a pause and when no first messages are due (with one message per
/// target: while no scan is open). Its stamp is late by the frames lost before it, 0.25 ms each, at
/// most four. Its counter is one cycle after the last; `announced` is the number of targets with at
/// least one part.
///
/// A list with the counter of the last one (without header: within the time-out of its last part)
/// is that list again, and dropped, until one of its parts has other bytes than in the last list:
/// then the sensor's counter stands still, and the list is a new scan.
///
/// Counter steps: the first step is one cycle until a smaller one comes twice in a row, or a larger
/// one 16 times; larger steps are gaps. A 16-bit counter that goes back by less than half its
/// range, or skips more cycles than the time held, is that of a restarted sensor, not a gap.
///
/// Stamps may run backwards. A part is in time if it is within the time-out of the last part, in
/// either direction.
class ScanAssembler {
 public:
  /// `decoder` must outlive the assembler. An open scan closes as incomplete when no part of it
  /// comes for `timeout_us`. `stamp_offset_us` is added to the stamps of scans.
  ScanAssembler(const RadarDecoder& decoder, std::int64_t timeout_us,
                std::int64_t stamp_offset_us = 0);

  void add(const ScanPart& part);

  /// Closes the open scan if its last part is older than the time-out.
  void expire(std::int64_t now_us);

  /// Whether expire() would close a scan.
  [[nodiscard]] bool is_overdue(std::int64_t now_us) const;
  /// When the open scan times out if no further part comes; nothing if no scan is open.
  [[nodiscard]] std::optional<std::int64_t> deadline_us() const {
    return is_open_ ? std::optional(shifted(open_.last_part_us, timeout_us_)) : std::nullopt;
  }

  /// Stamp of the open scan; nothing if no scan is open.
  [[nodiscard]] std::optional<std::int64_t> open_stamp_us() const;

  /// The frame source lost frames: the open scan, if any, becomes incomplete.
  void mark_dropped();

  /// End of input: closes the open scan.
  void finish();

  /// Messages the open scan still waits for, within its capacity; nothing if no scan is open.
  [[nodiscard]] std::optional<std::size_t> awaited_parts() const;

  /// The oldest closed scan not yet handed out, or nullptr. Valid until the next call of add,
  /// expire or finish.
  const RadarScan* next();

  [[nodiscard]] const AssemblerCounters& counters() const { return counters_; }

 private:
  /// State of the open scan.
  struct OpenScan {
    std::int64_t stamp_us = 0;
    std::int64_t last_part_us = 0;
    std::uint16_t counter = 0;
    std::uint16_t announced = 0;
    std::uint16_t known = 0;  ///< Targets with at least one part: valid entries in order_.
    std::uint16_t whole = 0;  ///< Targets with all parts.
    std::uint16_t parts = 0;
    bool has_later_messages = false;  ///< A second or later message of a target came.
    bool conflicting = false;
    bool dropped = false;
    bool has_header = true;
    bool may_repeat = false;  ///< All parts so far equal those of the last list: perhaps no scan.
    /// By slot; bit n: message n came.
    std::array<std::uint8_t, kMaxDetections> messages{};
  };

  /// Stamps are external input: their sum may overflow a signed number.
  static std::int64_t shifted(std::int64_t stamp_us, std::int64_t offset_us) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(stamp_us) +
                                     static_cast<std::uint64_t>(offset_us));
  }
  void note_stamp(std::int64_t stamp_us);
  [[nodiscard]] std::uint32_t step_to(std::uint16_t counter, std::uint16_t from) const;
  [[nodiscard]] bool in_time(std::int64_t stamp_us, std::int64_t last_part_us) const;
  void time_out();

  void add_header(const ScanPart& part);
  [[nodiscard]] bool begins_next(const ScanPart& part) const;
  void add_repeated_header(const ScanPart& part);
  void adopt_header(const ScanPart& part);
  [[nodiscard]] bool is_damaged_header(const ScanPart& part) const;
  [[nodiscard]] bool begins_list(const ScanPart& part) const;
  void open_without_header(const ScanPart& part);
  void add_announced(const ScanPart& part);
  void add_unannounced(const ScanPart& part);
  void store(const ScanPart& part);
  void note_conflict(const ScanPart& part);
  [[nodiscard]] bool differs_from_last(const ScanPart& part) const;
  void compare(const Payload& stored, const Payload& repeated);
  bool admit(std::uint8_t slot);

  void open(const ScanPart& part, std::uint16_t announced, bool may_repeat);
  void note_step(const ScanPart& part);
  [[nodiscard]] std::size_t capacity() const;
  [[nodiscard]] std::uint64_t missing_parts(std::uint64_t targets) const;
  [[nodiscard]] bool is_whole() const;
  [[nodiscard]] ScanStatus status() const;
  void close();
  void drop();
  void hand_out();
  void fill(RadarScan& scan) const;
  void count(const RadarScan& scan);

  const RadarDecoder* decoder_;
  ScanFraming framing_;
  std::int64_t timeout_us_;
  std::int64_t stamp_offset_us_;
  AssemblerCounters counters_;
  std::optional<std::int64_t> last_stamp_us_;
  bool is_after_pause_ = false;   ///< The last part came after a pause.
  bool is_list_refused_ = false;  ///< The last header repeated a list.

  bool is_open_ = false;
  OpenScan open_;
  std::array<TargetPayload, kMaxDetections> targets_{};  ///< By slot.
  std::array<std::uint8_t, kMaxDetections> order_{};     ///< Slots in order of arrival.

  std::optional<std::uint16_t> closed_counter_;  ///< Of the last closed scan.
  std::int64_t closed_part_us_ = 0;              ///< Last part of that scan, including late ones.
  /// OpenScan::messages of the last list, a repeated one too.
  std::array<std::uint8_t, kMaxDetections> last_messages_{};
  std::uint32_t cycle_step_ = 0;  ///< Of the counter; 0: not known yet.
  std::uint32_t last_step_ = 0;   ///< Of the counter, and how often in a row.
  std::uint32_t equal_steps_ = 0;

  std::array<RadarScan, 2> waiting_{};
  std::size_t oldest_ = 0;
  std::size_t waiting_count_ = 0;
};

}  // namespace cremed
