// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "cremed/estimator/fusion/state/radar_set.hpp"

namespace cremed {

/// Which radars are at fault, and until when: for a hold time after the last evidence, since a
/// mirrored mount or a late bus shows in turns or when braking only. The hold doubles each time a
/// radar is found at fault, and is halved again over the time without.
class Convictions {
 public:
  explicit Convictions(std::size_t radars) : verdicts_(radars) {}

  /// To be called when the clock of the stamps was set: those at fault remain so.
  void leave_clock();
  void convict(std::size_t radar, std::int64_t time_us);
  /// Likewise, by the radar's own check. If most of the radars that are `heard` are at fault, so
  /// that there is no odometry, the hold is shorter: the own check itself tells when the fault is
  /// over.
  void accuse(std::size_t radar, RadarSet heard, std::int64_t time_us);
  /// From now on these radars are not at fault.
  void acquit(RadarSet set);
  /// Releases the radars of `set` whose hold is over.
  void release(std::int64_t time_us);

  [[nodiscard]] RadarSet at_fault() const { return at_fault_; }
  /// The radars at fault by their own checks.
  [[nodiscard]] RadarSet accused() const { return accused_; }
  /// True once after a radar was found at fault.
  bool take_new() { return std::exchange(is_new_, false); }

 private:
  struct Verdict {
    std::optional<std::int64_t> until_us;  // None since the clock was set.
    std::int64_t hold_us = 0;
    std::int64_t shared_hold_us = 0;  // If most radars are at fault.
  };

  std::vector<Verdict> verdicts_;
  RadarSet at_fault_ = 0;
  RadarSet accused_ = 0;
  bool is_new_ = false;
};

}  // namespace cremed
