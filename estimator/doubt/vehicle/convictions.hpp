// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "cremed/estimator/doubt/vehicle/radar_set.hpp"

namespace cremed {

/// Which radars are at fault, and until when: for some time after the last evidence, each time
/// twice as long, halved again while nothing happens. A mirrored mount or a late bus shows in turns
/// or when braking only.
class Convictions {
 public:
  /// `judged`: the radars that count for what is most of them.
  Convictions(std::size_t radars, RadarSet judged) : verdicts_(radars), judged_(judged) {}

  /// To be called when the clock of the stamps was set: those at fault remain so.
  void leave_clock();
  void convict(std::size_t radar, std::int64_t time_us);
  /// Likewise, by the radar's own check. That says itself when a fault is over: if most radars are
  /// at fault, and there is no odometry, for a shorter time.
  void accuse(std::size_t radar, std::int64_t time_us);
  /// They are not at fault: those that convicted them are.
  void acquit(RadarSet set);
  /// Releases those whose time is over.
  void release(RadarSet set, std::int64_t time_us);

  [[nodiscard]] RadarSet at_fault() const { return at_fault_; }
  /// By their own checks.
  [[nodiscard]] RadarSet accused() const { return accused_; }
  /// A radar was found at fault. Once.
  bool take_new() { return std::exchange(is_new_, false); }

 private:
  struct Verdict {
    std::optional<std::int64_t> until_us;  // None: not yet by the clock as it was set.
    std::int64_t hold_us = 0;
    std::int64_t shared_hold_us = 0;  // If most radars are at fault by their own checks.
  };

  std::vector<Verdict> verdicts_;
  RadarSet judged_;
  RadarSet at_fault_ = 0;
  RadarSet accused_ = 0;
  bool is_new_ = false;
};

}  // namespace cremed
