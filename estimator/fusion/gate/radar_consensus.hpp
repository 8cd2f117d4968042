// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "cremed/estimator/fusion/gate/joint_velocity.hpp"
#include "cremed/estimator/fusion/gate/radar_trust.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"

namespace cremed {

/// Which radars agree with the filter, by their last scans, and which contradict it: a majority of
/// radars that contradict it and agree with each other shows that the filter is wrong.
class RadarConsensus {
 public:
  /// Options and mounts are those of the state, which must outlive this.
  explicit RadarConsensus(const OdometryState& state);

  void clear();
  [[nodiscard]] RadarTrust& operator[](std::size_t radar) { return trusts_[radar]; }
  [[nodiscard]] const RadarTrust& operator[](std::size_t radar) const { return trusts_[radar]; }

  // Radars that are believed, by their scans of the last 0.3 s.
  [[nodiscard]] int agreeing(std::int64_t time_us) const { return count(time_us, true); }
  [[nodiscard]] int contradicting(std::int64_t time_us) const { return count(time_us, false); }
  /// Velocity of those that contradict, if they are the majority, two or more, and agree.
  [[nodiscard]] std::optional<JointVelocity> contradicting_majority(std::int64_t time_us) const;
  /// For how long a radar has contradicted, at most.
  [[nodiscard]] double longest_contradiction_s() const;
  /// Radars as a bit set.
  [[nodiscard]] std::uint32_t left_out() const;

 private:
  [[nodiscard]] int count(std::int64_t time_us, bool agree) const;

  const OdometryState& state_;
  std::vector<RadarTrust> trusts_;
};

}  // namespace cremed
