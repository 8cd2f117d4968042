// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "cremed/can_decoders/can_frame.hpp"
#include "cremed/can_decoders/radar_scan.hpp"
#include "daemon/configuration/configuration.hpp"

namespace cremed {

/// The stamps of each bus compared with those of its frames before and of the other buses.
class BusClocks {
 public:
  /// Notes each frame, in the order of arrival.
  void note(const CanFrame& frame);
  /// Whether the clocks of two buses agree, as far as known: the frames of both were never stamped
  /// before an earlier frame of the other by more than kMaxDifferenceUs.
  [[nodiscard]] bool agree(std::uint8_t a, std::uint8_t b) const {
    return follows(a, b) && follows(b, a);
  }
  /// The half of it that frames of `interface` have shown: a frame of `other` tells its time.
  [[nodiscard]] bool follows(std::uint8_t interface, std::uint8_t other) const {
    return interface == other || (clocks_[interface].followed & bit_of(other)) != 0;
  }

  /// Notes a frame of a radar. True if its stamp and those of the frames before it
  /// are kSetBackUs or more before the latest of its bus: the clock was set.
  bool is_set_back(const CanFrame& frame);
  /// Whether the stamps of a bus are kAheadUs or more ahead of those of all other buses that send:
  /// its own clock is wrong, since frames cannot arrive before they are sent.
  [[nodiscard]] bool is_ahead(std::uint8_t interface) const {
    return clocks_[interface].frames_behind >= kMinFramesBehind;
  }

 private:
  /// Between synchronised hardware stamps and the order of arrival; a fraction of any time-out.
  static constexpr std::int64_t kMaxDifferenceUs = 5'000;
  /// Frames of one bus overtake each other by 5 ms at most (20 frames at 500 kbit/s).
  static constexpr std::int64_t kSetBackUs = 50'000;
  /// In a row: a single frame may have waited for the next list.
  static constexpr std::uint32_t kMinFramesBack = 3;
  /// Beyond max_lateness_s of the odometry, which then takes the scans of the others for late.
  static constexpr std::int64_t kAheadUs = 500'000;
  /// In a row and of other buses: a cluster list of an ARS408.
  static constexpr std::uint32_t kMinFramesBehind = 25;
  struct Clock {
    std::optional<std::int64_t> latest_us;
    std::uint32_t frames_back = 0;    // Stamped that much before it.
    std::uint32_t frames_behind = 0;  // Of other buses, stamped that much earlier.
    std::uint32_t followed = 0;       // Bit i: this bus and bus i agree, by frames of this one.
  };
  /// One a radar, and the vehicle's.
  static constexpr std::size_t kMaxBuses = kMaxRadars + 1;
  static_assert(kMaxBuses <= 32);
  static constexpr std::uint32_t bit_of(std::uint8_t interface) { return 1U << interface; }

  std::array<Clock, kMaxBuses> clocks_{};
  struct Last {
    std::uint8_t interface;
    std::int64_t stamp_us;
  };
  std::optional<Last> last_;  // Frame.
};

/// The stamps of one radar's scans compared with its cycle counter: shows that the clock was set
/// forward, where a log has only a pause.
class ScanClock {
 public:
  explicit ScanClock(std::uint32_t counter_modulus) : modulus_(counter_modulus) {}

  /// True if a scan comes more than kStepS later than its counter says.
  bool is_set_forward(const RadarScan& scan);
  void forget() { last_.reset(); }

 private:
  /// On recorded drives (nuScenes, RadarScenes, 9000 scans of ARS408) that is 0.008 s at most.
  static constexpr double kStepS = 0.05;
  /// Scans in a row with one period before a step is believed.
  static constexpr int kMinConfirmations = 10;
  /// Shorter counters pass through zero in a pause.
  static constexpr std::uint32_t kMinModulus = 4096;
  struct Scan {
    std::int64_t stamp_us;
    std::uint16_t counter;
  };

  std::uint32_t modulus_;
  std::optional<Scan> last_;
  double period_s_ = 0.0;  // Of one count.
  int confirmations_ = 0;
};

}  // namespace cremed
