// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "test/faults/fault_drive.hpp"
#include "test/faults/frame_faults.hpp"

namespace cremed::test {

inline constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

/// Puts a fault into the frames of a drive.
using PutIn = std::function<Frames(const FaultDrive&, FaultTime)>;

/// `with(frames, time, arguments...)`, a function with_...(), as a fault.
template <typename With, typename... Arguments>
PutIn put(With with, Arguments... arguments) {
  return [=](const FaultDrive& d, FaultTime t) { return with(d.frames, t, arguments...); };
}

/// The second fault in a drive that has the first.
inline PutIn both(PutIn first, PutIn second) {
  return [first = std::move(first), second = std::move(second)](FaultDrive d, FaultTime t) {
    d.frames = first(d, t);
    return second(d, t);
  };
}

/// The radars that look along the vehicle's axis are silent.
inline Frames only_sides(const FaultDrive& d, FaultTime t) {
  return with_silence(d.frames, t, [&](std::size_t radar) { return !d.is_side(radar); });
}

/// A kind with its size.
inline std::string fault_kind(const char* format, double value) {
  char result[64];
  std::snprintf(result, sizeof result, format, value);
  return result;
}

/// One fault of one drive.
struct FaultCase {
  using Radars = std::vector<RadarConfiguration>;

  std::string kind;
  std::string of;  ///< The faulty radar; empty: all, or none.
  FaultTime time;
  /// Changes the frames; empty: they stay as they are.
  PutIn put_in{};
  /// Offset of the stamps of radar `of` to truth's clock: it is judged by its own clock.
  std::int64_t clock_offset_us = 0;
  /// The clock of all stamps is set by this at the beginning of `time`.
  std::int64_t clock_step_us = 0;
  /// Changes the configuration; empty: it stays as it is.
  std::function<void(Radars&)> configure{};
  /// What an earlier drive is said to have learned, by radar.
  std::vector<std::optional<LearnedErrors>> learned{};
  /// Bit i: radar i is at fault, by itself or because its configuration is wrong.
  std::uint32_t guilty = 0;
  /// What is wrong with them, if it is one of these.
  FaultKind cause = FaultKind::unknown;
  /// What is wrong with them changes: any cause may be named.
  bool changes = false;
  /// Those of `guilty` with another cause, and it.
  std::uint32_t others_guilty = 0;
  FaultKind cause_of_others = FaultKind::unknown;
  /// So small that it may be learned, or cannot be told: the guilty radar need not be named if
  /// poses are right.
  bool may_be_learned = false;

  [[nodiscard]] FaultKind cause_of(std::size_t radar) const {
    return (others_guilty >> radar & 1U) != 0 ? cause_of_others : cause;
  }
  /// A step of the clock is over at once.
  [[nodiscard]] std::int64_t end_us() const {
    return clock_step_us != 0 ? time.from_us : time.until_us;
  }
  [[nodiscard]] bool ends() const { return end_us() < kNever; }
};

/// What the pipeline made of a drive with a fault.
struct FaultRecord {
  RecordingSink sink;
  /// By row of the odometry: the step of the clock before the frame that gave it, and that frame's
  /// stamp.
  struct Given {
    std::int64_t clock_step_us = 0;
    std::int64_t frame_us = 0;
  };
  std::vector<Given> given;
};

inline FaultRecord record(const FaultDrive& drive, const FaultCase& fault,
                          bool keeps_scans = true) {
  FaultCase::Radars radars = drive.radars;
  if (fault.configure) fault.configure(radars);
  const Frames frames = fault.put_in ? fault.put_in(drive, fault.time) : drive.frames;
  FaultRecord result{RecordingSink(radars.size(), keeps_scans), {}};
  Pipeline pipeline(configuration_of(radars), kNoSource, {&result.sink}, {}, fault.learned);
  FaultRecord::Given given;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const bool is_stepped = fault.clock_step_us != 0 && fault.time.has(drive.frames[i]);
    given = {is_stepped ? fault.clock_step_us : 0, frames[i].stamp_us};
    pipeline.on_frame(frames[i]);
    result.given.resize(result.sink.odometries.size(), given);
  }
  pipeline.finish();
  result.given.resize(result.sink.odometries.size(), given);
  return result;
}

}  // namespace cremed::test
