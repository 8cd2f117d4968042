// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/radar/speed_jump.hpp"

#include <algorithm>
#include <cmath>

#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

/// A third above the maximum of healthy drives, see SpeedJump.
constexpr double kMinJumpMps = 0.45;
constexpr double kSigmas = 5.0;
/// Largest change before and after, as a share of the jump. It is 1 if a single scan is wrong.
constexpr double kMaxShareBeside = 0.4;
/// Largest change that is steady, as a share of kMinJumpMps.
constexpr double kSteadyShare = 0.5;
/// Longer periods have a missing scan: over that time a vehicle too may change its speed.
constexpr double kMaxPeriodS = 0.16;

}  // namespace

std::optional<SpeedJump::Jump> SpeedJump::add(std::int64_t stamp_us,
                                              const DopplerVelocity& velocity) {
  std::shift_left(speeds_.begin(), speeds_.end(), 1);
  speeds_.back() = {stamp_us, velocity.velocity_mps.x(), velocity.covariance(0, 0)};
  count_ = std::min(count_ + 1, speeds_.size());
  if (count_ < speeds_.size()) {
    return std::nullopt;
  }
  std::array<double, 3> changes_mps{};
  std::array<double, 3> periods_s{};
  for (std::size_t i = 0; i < changes_mps.size(); ++i) {
    periods_s[i] = seconds_between(speeds_[i].stamp_us, speeds_[i + 1].stamp_us);
    changes_mps[i] = speeds_[i + 1].mps - speeds_[i].mps;
    const double outstanding_mps = changes_mps[i] - (speeds_[3].mps - speeds_[0].mps) / 3.0;
    const bool is_gap = !(periods_s[i] > 0.0 && periods_s[i] <= kMaxPeriodS);
    if (is_gap || std::abs(outstanding_mps) > kSteadyShare * kMinJumpMps) {
      unsteady_us_ = stamp_us;
    }
    if (is_gap) {
      return std::nullopt;
    }
  }
  const double steady_mps =
      0.5 * periods_s[1] * (changes_mps[0] / periods_s[0] + changes_mps[2] / periods_s[2]);
  // A late stamp makes one period long and the next short, and no change larger.
  const double jump_mps =
      std::min(std::abs(changes_mps[1] - steady_mps),
               std::abs(changes_mps[1] - 0.5 * (changes_mps[0] + changes_mps[2])));
  const double beside_mps = std::max(std::abs(changes_mps[0]), std::abs(changes_mps[2]));
  const auto& [a, b, c, d] = speeds_;
  const double variance = 2.25 * (b.variance + c.variance) + 0.25 * (a.variance + d.variance);
  const bool is_jump = jump_mps > kMinJumpMps + kSigmas * std::sqrt(variance) &&
                       beside_mps < kMaxShareBeside * jump_mps;
  return is_jump ? std::optional(Jump{c.stamp_us, b.mps, c.mps}) : std::nullopt;
}

}  // namespace cremed
