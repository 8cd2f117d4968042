// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "cremed/estimator/doubt/vehicle/motion_sums.hpp"
#include "cremed/estimator/doubt/vehicle/radar_trust.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"
#include "cremed/estimator/fusion/state/radar_set.hpp"
#include "cremed/estimator/scan/pose2.hpp"

namespace cremed {

/// Majority vote of the radars: which of them agree with the filter by their last scans, and which
/// contradict it. If a majority contradicts the filter and agrees with each other, the filter is
/// wrong.
class RadarConsensus {
 public:
  /// Uses options and mounts of `state`, which must outlive this object.
  explicit RadarConsensus(const OdometryState& state);

  void clear();
  [[nodiscard]] RadarTrust& operator[](std::size_t radar) { return trusts_[radar]; }
  [[nodiscard]] const RadarTrust& operator[](std::size_t radar) const { return trusts_[radar]; }

  // Trusted radars, by their scans of the last 0.3 s.
  [[nodiscard]] RadarSet agreeing(std::int64_t time_us) const { return voting(time_us, true); }
  [[nodiscard]] RadarSet contradicting(std::int64_t time_us) const {
    return voting(time_us, false);
  }
  /// The motion by the contradicting radars, if they are two or more, the majority, and agree with
  /// each other.
  [[nodiscard]] std::optional<MotionSums> contradicting_majority(std::int64_t time_us) const;
  /// Whether of the other radars only witnesses vote.
  [[nodiscard]] bool is_only_voter(std::size_t radar, std::int64_t time_us) const {
    const RadarSet voting = agreeing(time_us) | contradicting(time_us);
    return (voting & ~state_.witnesses() & ~set_of(radar)) == 0;
  }
  /// All contradictions are later than the last agreement: all radars changed at once.
  [[nodiscard]] bool is_step(std::int64_t time_us) const;
  /// Whether half or more of the contradicting radars contradict their own positions.
  [[nodiscard]] bool contradicts_positions(std::int64_t time_us) const;
  /// Longest time for which a radar has contradicted.
  [[nodiscard]] double longest_contradiction_s() const;
  /// A radar that looks sideways and repeatedly contradicts the filter; FaultHypotheses judges the
  /// others.
  [[nodiscard]] bool is_left_out(std::size_t radar) const {
    return trusts_[radar].is_left_out && looks_across(state_.mount(radar));
  }
  /// Radars that are left out for RadarTrust::kFaultyS and more.
  [[nodiscard]] RadarSet at_fault() const;

 private:
  [[nodiscard]] RadarSet voting(std::int64_t time_us, bool agree) const;

  const OdometryState& state_;
  std::vector<RadarTrust> trusts_;
};

}  // namespace cremed
