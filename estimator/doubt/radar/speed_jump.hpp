// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "cremed/estimator/motion/doppler_velocity.hpp"

namespace cremed {

/// Whether a change of the speed undoes half of an earlier one or more.
inline bool reverses(double change_mps, double earlier_mps) {
  return change_mps * earlier_mps < -0.5 * earlier_mps * earlier_mps;
}

/// Detects a jump of a radar's speed along the vehicle by Doppler: it changes between two scans,
/// and neither before nor after. No vehicle moves so, since brakes take 0.1 s or more to act, and
/// then go on acting: a fault of the radar begins or ends. (Sideways speed does not tell: a change
/// of the yaw rate is seen by a radar in front only.)
///
/// Of four speeds a, b, c, d the change from b to c is compared with the mean of those from a to b
/// and from c to d. In 14000 scans of the recorded drives, forwards and backwards, the difference
/// is 0.34 m/s at most.
class SpeedJump {
 public:
  struct Jump {
    std::int64_t stamp_us = 0;  ///< Of the first scan after it.
    double before_mps = 0.0;
    double after_mps = 0.0;

    [[nodiscard]] double change_mps() const { return after_mps - before_mps; }
  };

  /// Adds the velocity of the next scan. Returns the jump if the previous scan was the first after
  /// one.
  std::optional<Jump> add(std::int64_t stamp_us, const DopplerVelocity& velocity);
  /// Whether the radar has measured since `since_us` that the vehicle did not jump: no scan was
  /// missing among any four in a row, and no change stood out by half of a jump.
  [[nodiscard]] bool is_steady(std::int64_t since_us) const {
    return count_ == speeds_.size() && unsteady_us_ < since_us;
  }

 private:
  struct Speed {
    std::int64_t stamp_us = 0;
    double mps = 0.0;
    double variance = 0.0;
  };
  std::array<Speed, 4> speeds_;  // The oldest first.
  std::size_t count_ = 0;
  std::int64_t unsteady_us_ = std::numeric_limits<std::int64_t>::min();
};

}  // namespace cremed
