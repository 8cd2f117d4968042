// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Faults of sensors, buses and clocks, injected into the frames of a healthy drive.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "cremed/can_decoders/can_frame.hpp"
#include "tools/simulate/random.hpp"

namespace cremed::test {

using Frames = std::vector<CanFrame>;

/// The time interval of a fault, by the stamps of the drive.
struct FaultTime {
  std::int64_t from_us = 0;
  std::int64_t until_us = 0;
  [[nodiscard]] bool has(const CanFrame& frame) const {
    return frame.stamp_us >= from_us && frame.stamp_us < until_us;
  }
};

inline constexpr std::uint64_t kFaultStream = 910;

/// Each frame is lost with that probability, unreported.
inline Frames with_loss(Frames frames, FaultTime time, double share) {
  Random random(1, kFaultStream);
  std::erase_if(frames,
                [&](const CanFrame& frame) { return time.has(frame) && random.chance(share); });
  return frames;
}

using RadarSelection = std::function<bool(std::size_t)>;
inline RadarSelection only(std::size_t radar) {
  return [radar](std::size_t each) { return each == radar; };
}
inline bool every_radar(std::size_t) { return true; }

/// Removes the frames of the radars selected by `is_silent`.
inline Frames with_silence(Frames frames, FaultTime time, const RadarSelection& is_silent) {
  std::erase_if(frames, [&](const CanFrame& frame) {
    return time.has(frame) && is_silent(std::size_t{frame.interface});
  });
  return frames;
}

/// Frames sorted by times of arrival that differ from their stamps; equal times keep their order.
class Arrivals {
 public:
  void add(std::int64_t arrival_us, const CanFrame& frame) {
    frames_.push_back({arrival_us, frame});
  }
  [[nodiscard]] Frames in_order() {
    std::stable_sort(frames_.begin(), frames_.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    Frames result;
    for (const auto& [arrival_us, frame] : frames_) result.push_back(frame);
    return result;
  }

 private:
  std::vector<std::pair<std::int64_t, CanFrame>> frames_;
};

/// A radar's frames arrive 50 to 150 ms after their stamps, in order.
inline Frames with_lateness(const Frames& frames, FaultTime time, std::size_t radar) {
  constexpr double kMeanUs = 100'000.0;
  constexpr double kDelayAmplitudeUs = 50'000.0;
  constexpr double kPeriodUs = 3e6;
  Arrivals arrivals;
  for (const CanFrame& frame : frames) {
    const double phase = 2.0 * std::numbers::pi *
                         static_cast<double>(frame.stamp_us - frames.front().stamp_us) / kPeriodUs;
    const bool is_late = frame.interface == radar && time.has(frame);
    const double late_us = is_late ? kMeanUs + kDelayAmplitudeUs * std::sin(phase) : 0.0;
    arrivals.add(frame.stamp_us + static_cast<std::int64_t>(late_us), frame);
  }
  return arrivals.in_order();
}

/// The clock of one radar's bus is ahead; frames arrive as before.
inline Frames with_clock_offset(Frames frames, FaultTime time, std::size_t radar,
                                std::int64_t ahead_us) {
  for (CanFrame& frame : frames) {
    if (frame.interface == radar && time.has(frame)) frame.stamp_us += ahead_us;
  }
  return frames;
}

/// Two sensors with one id: the frames of radar `other` also appear on the bus of `radar`.
inline Frames with_doubled_id(const Frames& frames, FaultTime time, std::size_t radar,
                              std::size_t other) {
  Frames result;
  for (const CanFrame& frame : frames) {
    result.push_back(frame);
    if (frame.interface == other && time.has(frame)) {
      result.push_back(frame);
      result.back().interface = static_cast<std::uint8_t>(radar);
    }
  }
  return result;
}

/// On each bus, every so many frames one is overtaken by 1 to 20 others; half of the delayed frames
/// get the stamp of the last of these.
inline Frames with_reordering(const Frames& frames, FaultTime time, double share) {
  constexpr std::size_t kMaxOvertaking = 20;
  struct Held {
    CanFrame frame;
    std::size_t overtaken_by = 0;
    bool keeps_stamp = false;
  };
  Random random(1, kFaultStream);
  std::vector<std::optional<Held>> held(256);
  Frames result;
  const auto release = [&](std::optional<Held>& late, std::int64_t stamp_us) {
    result.push_back(late->frame);
    if (!late->keeps_stamp) result.back().stamp_us = stamp_us;
    late.reset();
  };
  for (const CanFrame& frame : frames) {
    auto& late = held[frame.interface];
    if (!late && time.has(frame) && random.chance(share)) {
      late = Held{frame, 1 + random.index(kMaxOvertaking), random.chance(0.5)};
      continue;
    }
    result.push_back(frame);
    if (late && --late->overtaken_by == 0) release(late, frame.stamp_us);
  }
  for (auto& late : held) {
    if (late) release(late, late->frame.stamp_us);
  }
  return result;
}

/// In that share of frames, one bit of the data is flipped; in a tenth of that share, one bit of
/// the id.
inline Frames with_bit_flips(Frames frames, FaultTime time, double share) {
  constexpr double kIdShare = 0.1;
  constexpr std::size_t kIdBits = 11;
  Random random(1, kFaultStream);
  for (CanFrame& frame : frames) {
    if (time.has(frame) && frame.length > 0 && random.chance(share)) {
      frame.data[random.index(frame.length)] ^= static_cast<std::uint8_t>(1U << random.index(8));
    }
    if (time.has(frame) && random.chance(kIdShare * share)) {
      frame.id ^= 1U << random.index(kIdBits);
    }
  }
  return frames;
}

/// The frames of radar i arrive on the bus of radar `bus_of[i]`.
inline Frames with_buses(Frames frames, FaultTime time, const std::vector<std::uint8_t>& bus_of) {
  for (CanFrame& frame : frames) {
    if (time.has(frame)) frame.interface = bus_of.at(frame.interface);
  }
  return frames;
}

/// A gateway holds a radar's frames and stamps them when it passes them on.
inline Frames with_late_stamps(const Frames& frames, FaultTime time, std::size_t radar,
                               std::int64_t late_us) {
  Arrivals arrivals;
  for (CanFrame frame : frames) {
    if (frame.interface == radar && time.has(frame)) frame.stamp_us += late_us;
    arrivals.add(frame.stamp_us, frame);
  }
  return arrivals.in_order();
}

/// The computer stands still for a while each period: what came meanwhile is stamped at its end.
inline Frames with_halts(Frames frames, FaultTime time, std::int64_t period_us,
                         std::int64_t halt_us) {
  for (CanFrame& frame : frames) {
    const std::int64_t since_us = (frame.stamp_us - time.from_us) % period_us;
    if (time.has(frame) && since_us < halt_us) frame.stamp_us += halt_us - since_us;
  }
  return frames;
}

/// The clock of all buses is set; frames arrive as before.
inline Frames with_clock_step(Frames frames, FaultTime time, std::int64_t step_us) {
  for (CanFrame& frame : frames) {
    if (time.has(frame)) frame.stamp_us += step_us;
  }
  return frames;
}

}  // namespace cremed::test
