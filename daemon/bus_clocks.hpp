// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "cremed/can_decoders/can_frame.hpp"
#include "cremed/can_decoders/radar_scan.hpp"
#include "cremed/estimator/fusion/state/radar_set.hpp"
#include "daemon/configuration/configuration.hpp"

namespace cremed {

/// Compares the stamps of each bus with those of its earlier frames and of the other buses.
class BusClocks {
 public:
  /// Notes each frame, in the order of arrival.
  void note(const CanFrame& frame);
  /// Whether the clocks of two buses agree, as far as known: the frames of both were never stamped
  /// before an earlier frame of the other by more than kMaxDifferenceUs.
  [[nodiscard]] bool agree(std::uint8_t a, std::uint8_t b) const {
    return follows(a, b) && follows(b, a);
  }
  /// agree() by the frames of `interface` only: a stamp of `other` is then a time of `interface`
  /// too.
  [[nodiscard]] bool follows(std::uint8_t interface, std::uint8_t other) const {
    return interface == other || contains(clocks_[interface].followed, other);
  }

  /// Notes a frame of a radar. True if its stamp and those of the frames before it
  /// are kSetBackUs or more before the latest of its bus: the clock was set.
  bool is_set_back(const CanFrame& frame);
  /// Whether the stamps of a bus are ahead of those of all other buses that send: its own clock is
  /// wrong, since frames cannot arrive before they are sent.
  [[nodiscard]] bool is_ahead(std::uint8_t interface) const {
    return clocks_[interface].ahead.is_shown;
  }
  /// Whether its stamps are behind those of all others: its clock is wrong, or its frames come
  /// late.
  [[nodiscard]] bool is_behind(std::uint8_t interface) const {
    return clocks_[interface].behind.is_shown;
  }

 private:
  /// Between synchronised hardware stamps and the order of arrival; a fraction of any time-out.
  static constexpr std::int64_t kMaxDifferenceUs = 5'000;
  /// Frames of one bus overtake each other by 5 ms at most (20 frames at 500 kbit/s).
  static constexpr std::int64_t kSetBackUs = 50'000;
  /// Frames in a row that show it: a single one may have waited for the next list.
  static constexpr std::uint32_t kMinFramesBack = 3;
  /// Longer than frames wait in a gateway (75 ms, a cycle). Stamps of the kernel, and logs sorted
  /// by stamps, differ by 1 ms. Of two buses either may be wrong; but no delay is as long as 0.5 s,
  /// so the one that is ahead is wrong.
  static constexpr std::int64_t kOffsetUs = 100'000;
  static constexpr std::int64_t kOffsetOfTwoUs = 500'000;

  /// Whether this bus is ahead (or behind), by pairs of successive frames of this bus and another.
  /// Frames with others between them can show that it is ahead, but not that it is not.
  struct Offset {
    /// More than single late frames: lists of ARS408 are 13 pairs a second or more.
    static constexpr int kMinPairs = 10;

    std::uint32_t by = 0;  // Bit i: bus i shows it.
    int pairs = 0;         // Pairs that show it, less those that do not.
    bool is_shown = false;

    /// Notes a pair of successive frames.
    void note(std::uint32_t other, bool shows_it, int least_buses);
  };
  struct Clock {
    std::int64_t last_us = 0;               // Stamp of its last frame.
    std::optional<std::int64_t> latest_us;  // Largest stamp of a radar's frame.
    std::uint32_t frames_back = 0;          // In a row, kSetBackUs before it.
    std::uint32_t followed = 0;  // Bit i: this bus and bus i agree, by frames of this one.
    Offset ahead;
    Offset behind;
  };
  /// One a radar, and the vehicle's.
  static constexpr std::size_t kMaxBuses = kMaxRadars + 1;
  static_assert(kMaxBuses <= 32);

  std::array<Clock, kMaxBuses> clocks_{};
  std::uint32_t buses_ = 0;  // That have sent.
  std::optional<std::uint8_t> last_interface_;
};

/// How a scan's stamp compares with the radar's cycle counter.
enum class ScanTiming : std::uint8_t {
  steady,       ///< As expected, or not known.
  late,         ///< The computer stood still, or its clock was set: the next scans tell.
  set_forward,  ///< The clock was set; without the counter it would be a pause.
};

/// A clock that was set forward, by the scans before and after it.
struct ForwardStep {
  double counted_s = 0.0;  ///< Between the scans, by the radar's counter.
  double by_s = 0.0;       ///< Between their stamps, beyond that; < 0: it was set back.
};

/// The stamps of one radar's scans compared with its cycle counter.
class ScanClock {
 public:
  explicit ScanClock(std::uint32_t counter_modulus) : modulus_(counter_modulus) {}

  ScanTiming judge(const RadarScan& scan);
  void forget();
  /// After ScanTiming::set_forward: the step. None after a long pause, when the counter proves
  /// nothing: the sensor may have started anew, or logs have been joined.
  [[nodiscard]] std::optional<ForwardStep> step() const;

 private:
  /// Least difference of stamp and counter that is a step. On recorded drives (nuScenes,
  /// RadarScenes, 9000 scans of ARS408) it is 0.008 s at most. With 0.05 s a Bosch GPR that a halt
  /// of 50 ms delayed at every 16th scan came into doubt.
  static constexpr double kStepS = 0.03;
  /// Scans in a row with one period before a step is believed.
  static constexpr int kMinConfirmations = 10;
  /// Late scans in a row that are no step. Frames that waited while the computer stood still are
  /// stamped at one time: each scan is less late than the one before. After a step all are equally
  /// late, with another period of the sensor more and more.
  static constexpr int kMaxLate = 3;
  /// A counter of smaller modulus wraps around in a pause: it tells the time up to a multiple of
  /// its turn (Bosch GPR: 4 scans, 0.4 s). After a pause of kMaxPauseS the sensor may have started
  /// anew.
  static constexpr std::uint32_t kMinModulus = 4096;
  static constexpr double kMaxPauseS = 2.0;
  struct Scan {
    std::int64_t stamp_us;
    std::uint16_t counter;
  };

  [[nodiscard]] bool turns_soon() const { return modulus_ < kMinModulus; }
  [[nodiscard]] double lateness_s(double passed_s, std::uint32_t counts) const;
  bool is_as_late(double late_s);

  std::uint32_t modulus_;
  std::optional<Scan> last_;
  double period_s_ = 0.0;  // Of one count.
  int confirmations_ = 0;
  double late_s_ = 0.0;  // Of the last late scan.
  int late_scans_ = 0;   // In a row.
  ForwardStep step_;     // Of the last late scan.
};

}  // namespace cremed
