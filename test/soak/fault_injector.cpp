// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "test/soak/fault_injector.hpp"

#include <algorithm>
#include <cmath>

namespace cremed::soak {
namespace {

constexpr std::uint64_t kStream = 900;

/// As in LiveSource: idle after this time without frames.
constexpr std::int64_t kIdleUs = 20'000;
constexpr std::int64_t kSilenceAfterDriveUs = 600'000;

constexpr std::int64_t microseconds(double seconds) {
  return static_cast<std::int64_t>(seconds * 1e6);
}

void flip_bit(std::uint32_t& word, std::size_t bit) { word ^= 1U << bit; }

CanFrame on_interface(std::uint8_t interface) {
  CanFrame frame;
  frame.interface = interface;
  return frame;
}

}  // namespace

FaultInjector::FaultInjector(std::uint64_t seed) : random_(seed, kStream) {
  for (Bus& bus : buses_) {
    bus.last_fault_us.fill(std::numeric_limits<std::int64_t>::min());
  }
}

void FaultInjector::begin(Simulation& drive) {
  drive_ = &drive;
  is_over_ = false;
  now_us_ = drive.scene().start_us();
  for (Bus& bus : buses_) {
    bus.last_us = now_us_;
    bus.silent_until_us = 0;
    bus.frames_to_lose = 0;
  }
}

SourceEvent FaultInjector::next(CanFrame& frame) {
  offset_us_ = next_offset_us_;
  if (events_.empty()) {
    refill();
  }
  if (events_.empty()) {
    return SourceEvent::end;
  }
  const Event event = events_.front();
  events_.pop_front();
  frame = event.frame;
  if (event.kind == SourceEvent::clock_step) {
    next_offset_us_ = event.frame.stamp_us;
    return event.kind;
  }
  now_us_ = std::max(now_us_, frame.stamp_us);
  frame.stamp_us += offset_us_;
  counters_.frames += event.kind == SourceEvent::frame ? 1 : 0;
  return event.kind;
}

void FaultInjector::refill() {
  while (events_.empty() && !is_over_) {
    if (const std::optional<CanFrame> frame = drive_->next()) {
      pass_time(frame->stamp_us);
      deliver(*frame);
    } else {
      end_drive();
    }
  }
}

void FaultInjector::end_drive() {
  for (Bus& bus : buses_) {
    release_late(bus, now_us_);
  }
  pass_time(now_us_ + kSilenceAfterDriveUs);
  is_over_ = true;
}

/// The event while no frame arrives.
void FaultInjector::pass_time(std::int64_t until_us) {
  for (std::int64_t idle_us = now_us_ + kIdleUs; idle_us < until_us; idle_us += kIdleUs) {
    CanFrame time;
    time.stamp_us = idle_us;
    push(SourceEvent::idle, time);
  }
}

void FaultInjector::deliver(const CanFrame& original) {
  Bus& bus = buses_[original.interface];
  const double elapsed_s = static_cast<double>(original.stamp_us - bus.last_us) * 1e-6;
  bus.last_us = original.stamp_us;
  disturb_clock(elapsed_s);
  if (lose(bus, original.interface, elapsed_s)) {
    return;
  }
  CanFrame frame = original;
  frame.stamp_us += static_cast<std::int64_t>(random_.uniform(0.0, kStampJitterUs));
  corrupt(bus, frame, elapsed_s);
  if (hold_back(bus, frame, elapsed_s)) {
    return;
  }
  push(SourceEvent::frame, frame);
  if (happens(FaultKind::frame_twice, bus, elapsed_s)) {
    push(SourceEvent::frame, frame);
  }
  if (bus.late && --bus.late->overtaken_by == 0) {
    release_late(bus, frame.stamp_us);
  }
}

void FaultInjector::disturb_clock(double elapsed_s) {
  // Called for each bus.
  if (!happens(FaultKind::clock_step, buses_[0], elapsed_s / kBuses)) {
    return;
  }
  buses_[1].last_fault_us[static_cast<std::size_t>(FaultKind::clock_step)] = buses_[0].last_us;
  const std::int64_t step_us = microseconds(severity(FaultKind::clock_step));
  CanFrame offset;
  offset.stamp_us = next_offset_us_ + (random_.chance(0.5) ? step_us : -step_us);
  push(SourceEvent::clock_step, offset);
}

/// Whether the frame is lost; starts, continues and ends all faults that lose frames.
bool FaultInjector::lose(Bus& bus, std::uint8_t interface, double elapsed_s) {
  if (happens(FaultKind::interface_down, bus, elapsed_s)) {
    bus.silent_until_us = bus.last_us + microseconds(severity(FaultKind::interface_down));
    push(SourceEvent::dropped, on_interface(interface));
  } else if (happens(FaultKind::cycles_lost, bus, elapsed_s)) {
    bus.silent_until_us = bus.last_us + microseconds(severity(FaultKind::cycles_lost));
  } else if (happens(FaultKind::burst_lost, bus, elapsed_s)) {
    bus.frames_to_lose = whole_severity(FaultKind::burst_lost);
  } else if (happens(FaultKind::loss_reported, bus, elapsed_s)) {
    bus.frames_to_lose = whole_severity(FaultKind::loss_reported);
    push(SourceEvent::dropped, on_interface(interface));
  } else if (happens(FaultKind::frame_lost, bus, elapsed_s)) {
    bus.frames_to_lose = 1;
  }
  if (bus.frames_to_lose > 0) {
    --bus.frames_to_lose;
    return true;
  }
  return bus.last_us < bus.silent_until_us;
}

void FaultInjector::corrupt(Bus& bus, CanFrame& frame, double elapsed_s) {
  if (happens(FaultKind::data_flip, bus, elapsed_s) && frame.length > 0) {
    const auto bit = static_cast<unsigned>(random_.index(8));
    frame.data[random_.index(frame.length)] ^= static_cast<std::uint8_t>(1U << bit);
  }
  if (happens(FaultKind::length_wrong, bus, elapsed_s)) {
    frame.length = static_cast<std::uint8_t>(whole_severity(FaultKind::length_wrong));
    std::fill(frame.data.begin() + frame.length, frame.data.end(), std::uint8_t{0});
  }
  if (happens(FaultKind::id_flip, bus, elapsed_s)) {
    constexpr std::size_t kIdBits = 11;
    const std::size_t bit = random_.index(kIdBits + 2);
    frame.extended = bit == kIdBits;
    frame.remote = bit == kIdBits + 1;
    if (bit < kIdBits) {
      flip_bit(frame.id, bit);
    }
  }
}

/// Later frames overtake it; it arrives with their stamp or its original one.
bool FaultInjector::hold_back(Bus& bus, const CanFrame& frame, double elapsed_s) {
  if (bus.late || !happens(FaultKind::frame_late, bus, elapsed_s)) {
    return false;
  }
  bus.late = LateFrame{frame, whole_severity(FaultKind::frame_late), random_.chance(0.5)};
  return true;
}

void FaultInjector::release_late(Bus& bus, std::int64_t stamp_us) {
  if (!bus.late) {
    return;
  }
  CanFrame frame = bus.late->frame;
  frame.stamp_us = bus.late->keeps_stamp ? frame.stamp_us : stamp_us;
  push(SourceEvent::frame, frame);
  bus.late.reset();
}

bool FaultInjector::happens(FaultKind kind, Bus& bus, double elapsed_s) {
  if (!random_.chance(elapsed_s / row_of(kind).mean_interval_s)) {
    return false;
  }
  const auto index = static_cast<std::size_t>(kind);
  bus.last_fault_us[index] = bus.last_us;
  ++counts_[index];
  return true;
}

double FaultInjector::severity(FaultKind kind) {
  const FaultRow& row = row_of(kind);
  return row.least * std::pow(row.most / row.least, random_.uniform());
}

int FaultInjector::whole_severity(FaultKind kind) {
  const FaultRow& row = row_of(kind);
  return static_cast<int>(random_.uniform(row.least, row.most + 1.0));
}

FaultSet FaultInjector::faults_since(std::size_t bus, std::int64_t true_us) const {
  FaultSet set = 0;
  for (std::size_t i = 0; i < kFaults.size(); ++i) {
    set |= buses_[bus].last_fault_us[i] >= true_us ? 1U << i : 0U;
  }
  return set;
}

}  // namespace cremed::soak
