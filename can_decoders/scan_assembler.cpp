// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/can_decoders/scan_assembler.hpp"

#include <algorithm>

namespace cremed {
namespace {

/// Shortest pause between two lists. Frames within a list are 0.25 ms apart; in 1263 lists of a
/// real ARS408 the shortest pause was 2.2 ms.
constexpr std::uint64_t kPauseUs = 1500;
/// A list begins with slot 0; a few messages may be lost together with the header.
constexpr std::uint8_t kLatestFirstSlot = 3;
/// A larger counter step in the middle of a list is a damaged header, not a gap.
constexpr std::uint32_t kMaxLostCycles = 8;
/// Equal counter steps in a row before a smaller, or a larger one, is the cycle. A damaged counter
/// gives one small step, a bus that loses every second list many large ones.
constexpr std::uint32_t kSmallerSteps = 2;
constexpr std::uint32_t kLargerSteps = 16;
/// Less than the cycle of any radar.
constexpr std::uint64_t kShortestCycleUs = 50'000;

/// Bits 0 to message - 1.
constexpr unsigned before(unsigned message) { return (1U << message) - 1U; }

/// Stamps are external input: their difference may overflow a signed number.
std::uint64_t distance(std::int64_t a, std::int64_t b) {
  const auto [low, high] = std::minmax(a, b);
  return static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low);
}

}  // namespace

ScanAssembler::ScanAssembler(const RadarDecoder& decoder, std::int64_t timeout_us,
                             std::int64_t stamp_offset_us)
    : decoder_(&decoder),
      framing_(decoder.framing()),
      timeout_us_(timeout_us),
      stamp_offset_us_(stamp_offset_us) {
  framing_.messages = std::clamp<std::uint8_t>(framing_.messages, 1, kMaxMessages);
}

void ScanAssembler::add(const ScanPart& part) {
  if (part.kind == ScanPart::Kind::none || part.message >= framing_.messages) {
    return;
  }
  note_stamp(part.stamp_us);
  if (is_open_ && !in_time(part.stamp_us, open_.last_part_us)) {
    time_out();
  }
  if (part.kind == ScanPart::Kind::header) {
    add_header(part);
  } else if (framing_.has_header) {
    add_announced(part);
  } else {
    add_unannounced(part);
  }
}

void ScanAssembler::expire(std::int64_t now_us) {
  if (is_overdue(now_us)) {
    time_out();
  }
}

bool ScanAssembler::is_overdue(std::int64_t now_us) const {
  // A clock set back does not show how long the scan has been waiting.
  return is_open_ && now_us > open_.last_part_us && !in_time(now_us, open_.last_part_us);
}

std::optional<std::int64_t> ScanAssembler::open_stamp_us() const {
  return is_open_ && !open_.may_repeat ? std::optional(shifted(open_.stamp_us, stamp_offset_us_))
                                       : std::nullopt;
}

void ScanAssembler::mark_dropped() { open_.dropped = true; }

void ScanAssembler::finish() {
  if (is_open_) {
    close();
  }
}

std::optional<std::size_t> ScanAssembler::awaited_parts() const {
  return is_open_ && !open_.may_repeat ? std::optional<std::size_t>(missing_parts(capacity()))
                                       : std::nullopt;
}

const RadarScan* ScanAssembler::next() {
  if (waiting_count_ == 0) {
    return nullptr;
  }
  const RadarScan* scan = &waiting_[oldest_];
  oldest_ = (oldest_ + 1) % waiting_.size();
  --waiting_count_;
  return scan;
}

void ScanAssembler::note_stamp(std::int64_t stamp_us) {
  if (last_stamp_us_ && stamp_us < *last_stamp_us_) {
    ++counters_.stamps_backwards;
  }
  is_after_pause_ = last_stamp_us_ && distance(stamp_us, *last_stamp_us_) > kPauseUs;
  last_stamp_us_ = stamp_us;
}

std::uint32_t ScanAssembler::step_to(std::uint16_t counter, std::uint16_t from) const {
  return (counter + framing_.counter_modulus - from) % framing_.counter_modulus;
}

bool ScanAssembler::in_time(std::int64_t stamp_us, std::int64_t last_part_us) const {
  return distance(stamp_us, last_part_us) <=
         static_cast<std::uint64_t>(std::max<std::int64_t>(timeout_us_, 0));
}

void ScanAssembler::time_out() {
  counters_.timeouts += open_.may_repeat ? 0 : 1;
  close();
}

void ScanAssembler::add_header(const ScanPart& part) {
  if (is_open_ && part.counter == open_.counter && !begins_next(part)) {
    open_.has_header ? add_repeated_header(part) : adopt_header(part);
    return;
  }
  if (is_damaged_header(part)) {
    note_conflict(part);
    return;
  }
  is_list_refused_ =
      is_open_ && open_.counter != closed_counter_ && part.counter == closed_counter_;
  finish();
  if (is_list_refused_) {
    ++counters_.repeated_scans;
  } else {
    open(part, part.target_count, part.counter == closed_counter_);
  }
}

/// While the counter stands still, a pause tells the next list from the open one.
bool ScanAssembler::begins_next(const ScanPart& part) const {
  return open_.counter == closed_counter_ && open_.parts != 0 && is_after_pause_ &&
         part.slot <= kLatestFirstSlot;
}

void ScanAssembler::add_repeated_header(const ScanPart& part) {
  if (part.target_count == open_.announced) {
    open_.last_part_us = part.stamp_us;
    ++counters_.duplicate_parts;
  } else {
    note_conflict(part);
  }
}

/// The late header of a scan that began without one.
void ScanAssembler::adopt_header(const ScanPart& part) {
  if (open_.has_later_messages || part.target_count < open_.known) {
    note_conflict(part);
    return;
  }
  open_.last_part_us = part.stamp_us;
  open_.announced = part.target_count;
  open_.has_header = true;
}

bool ScanAssembler::is_damaged_header(const ScanPart& part) const {
  return is_open_ && !is_after_pause_ && cycle_step_ != 0 && part.counter != closed_counter_ &&
         step_to(part.counter, open_.counter) > kMaxLostCycles * cycle_step_;
}

void ScanAssembler::note_conflict(const ScanPart& part) {
  open_.last_part_us = part.stamp_us;
  open_.conflicting = true;
  ++counters_.conflicting_parts;
}

bool ScanAssembler::begins_list(const ScanPart& part) const {
  const bool may_begin = is_open_ ? open_.has_later_messages : closed_counter_ && !is_list_refused_;
  return may_begin && is_after_pause_ && part.message == 0 && part.slot <= kLatestFirstSlot;
}

void ScanAssembler::open_without_header(const ScanPart& part) {
  finish();
  const std::uint32_t next = *closed_counter_ + std::max(cycle_step_, 1U);
  ScanPart begin = part;
  begin.counter = static_cast<std::uint16_t>(next % framing_.counter_modulus);
  open(begin, kMaxDetections, false);
  open_.has_header = false;
}

void ScanAssembler::add_announced(const ScanPart& part) {
  if (begins_list(part)) {
    open_without_header(part);
  }
  if (is_open_) {
    store(part);
  } else {
    ++counters_.orphan_parts;
  }
}

void ScanAssembler::add_unannounced(const ScanPart& part) {
  const bool of_open = is_open_ && part.counter == open_.counter;
  const bool of_closed = part.counter == closed_counter_ && in_time(part.stamp_us, closed_part_us_);
  if (is_open_ && !of_open && of_closed) {
    ++counters_.orphan_parts;
    closed_part_us_ = part.stamp_us;
    return;
  }
  if (!of_open || begins_next(part)) {
    finish();
    open(part, framing_.slot_count, of_closed);
  }
  store(part);
}

void ScanAssembler::store(const ScanPart& part) {
  open_.last_part_us = part.stamp_us;
  std::uint8_t& present = open_.messages[part.slot];
  Payload& stored = targets_[part.slot][part.message];
  if ((present >> part.message & 1U) != 0) {
    compare(stored, part.payload);
    return;
  }
  if (present == 0 && !admit(part.slot)) {
    return;
  }
  open_.may_repeat = open_.may_repeat && !differs_from_last(part);
  counters_.reordered_parts += (~present & before(part.message)) != 0 ? 1 : 0;
  stored = part.payload;
  present = static_cast<std::uint8_t>(present | 1U << part.message);
  ++open_.parts;
  if (present == before(framing_.messages)) {
    ++open_.whole;
  }
  open_.has_later_messages = open_.has_later_messages || part.message != 0;
  if (is_whole()) {
    close();
  }
}

/// Whether the last list had the part too, with other bytes. Those stay until they are replaced.
bool ScanAssembler::differs_from_last(const ScanPart& part) const {
  return (last_messages_[part.slot] >> part.message & 1U) != 0 &&
         targets_[part.slot][part.message] != part.payload;
}

void ScanAssembler::compare(const Payload& stored, const Payload& repeated) {
  if (stored == repeated) {
    ++counters_.duplicate_parts;
  } else {
    ++counters_.conflicting_parts;
    open_.conflicting = true;
  }
}

bool ScanAssembler::admit(std::uint8_t slot) {
  if (open_.known >= capacity()) {
    ++counters_.excess_parts;
    open_.conflicting = true;
    return false;
  }
  order_[open_.known++] = slot;
  return true;
}

void ScanAssembler::open(const ScanPart& part, std::uint16_t announced, bool may_repeat) {
  if (!may_repeat) {
    note_step(part);
  }
  open_ = {.stamp_us = part.stamp_us,
           .last_part_us = part.stamp_us,
           .counter = part.counter,
           .announced = announced,
           .may_repeat = may_repeat};
  is_open_ = true;
  if (is_whole()) {
    close();
  }
}

void ScanAssembler::note_step(const ScanPart& part) {
  if (!closed_counter_) {
    return;
  }
  const std::uint32_t modulus = framing_.counter_modulus;
  std::uint32_t step = step_to(part.counter, *closed_counter_);
  if (framing_.has_header && step > modulus / 2) {
    return;
  }
  step = step == 0 ? modulus : step;
  equal_steps_ = step == last_step_ ? equal_steps_ + 1 : 1;
  last_step_ = step;
  if (cycle_step_ == 0 || equal_steps_ >= (step < cycle_step_ ? kSmallerSteps : kLargerSteps)) {
    cycle_step_ = step;
  }
  const std::uint32_t missed = std::max(step / cycle_step_, 1U) - 1;
  const bool is_gap = missed <= distance(part.stamp_us, closed_part_us_) / kShortestCycleUs;
  counters_.missed_scans += is_gap || !framing_.has_header ? missed : 0;
}

std::size_t ScanAssembler::capacity() const {
  return std::min<std::size_t>(open_.announced, kMaxDetections);
}

std::uint64_t ScanAssembler::missing_parts(std::uint64_t targets) const {
  return framing_.messages * targets - open_.parts;
}

bool ScanAssembler::is_whole() const { return open_.whole == capacity(); }

ScanStatus ScanAssembler::status() const {
  if (open_.announced > kMaxDetections) {
    return ScanStatus::over_capacity;
  }
  if (open_.conflicting) {
    return ScanStatus::conflicting_parts;
  }
  if (open_.dropped) {
    return ScanStatus::dropped_frames;
  }
  return is_whole() && open_.has_header ? ScanStatus::complete : ScanStatus::missing_parts;
}

void ScanAssembler::close() {
  open_.may_repeat ? drop() : hand_out();
  last_messages_ = open_.messages;
  closed_counter_ = open_.counter;
  closed_part_us_ = open_.last_part_us;
  is_open_ = false;
}

void ScanAssembler::drop() {
  ++counters_.repeated_scans;
  counters_.orphan_parts += open_.parts;
}

void ScanAssembler::hand_out() {
  if (waiting_count_ == waiting_.size()) {
    next();
  }
  if (!open_.has_header) {
    open_.announced = open_.known;
  }
  RadarScan& scan = waiting_[(oldest_ + waiting_count_) % waiting_.size()];
  ++waiting_count_;
  fill(scan);
  count(scan);
}

void ScanAssembler::fill(RadarScan& scan) const {
  scan.stamp_us = shifted(open_.stamp_us, stamp_offset_us_);
  scan.counter = open_.counter;
  scan.status = status();
  scan.announced = open_.announced;
  scan.count = 0;
  for (std::size_t i = 0; i < open_.known; ++i) {
    const std::uint8_t slot = order_[i];
    if (open_.messages[slot] != before(framing_.messages)) {
      continue;
    }
    Detection detection = decoder_->detection(targets_[slot]);
    if (detection.validity != Validity::empty) {
      detection.id = slot;  // A GPR may leave its own number 0.
      scan.detections[scan.count++] = detection;
    }
  }
}

void ScanAssembler::count(const RadarScan& scan) {
  const bool complete = scan.status == ScanStatus::complete;
  ++counters_.scans;
  counters_.incomplete_scans += complete ? 0 : 1;
  counters_.headerless_scans += open_.has_header ? 0 : 1;
  counters_.empty_scans += complete && scan.count == 0 ? 1 : 0;
  counters_.missing_parts += missing_parts(open_.announced);
}

}  // namespace cremed
