// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/radar/velocity_jump.hpp"

#include <algorithm>

#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

constexpr double kMinJumpMps = 0.45;
constexpr double kSigmas = 5.0;
/// Of the jump: change per scan before and after.
constexpr double kMaxShareBeside = 0.4;
/// A missing scan: over a longer time a vehicle changes its speed as well.
constexpr double kMaxPeriodS = 0.16;

}  // namespace

std::optional<std::int64_t> VelocityJump::add(std::int64_t stamp_us,
                                              const DopplerVelocity& velocity) {
  std::shift_left(velocities_.begin(), velocities_.end(), 1);
  velocities_.back() = {stamp_us, velocity.velocity_mps, velocity.covariance.diagonal()};
  count_ = std::min(count_ + 1, velocities_.size());
  if (count_ < velocities_.size()) {
    return std::nullopt;
  }
  std::array<Eigen::Array2d, 3> changes;
  std::array<double, 3> periods_s{};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    periods_s[i] = seconds_between(velocities_[i].stamp_us, velocities_[i + 1].stamp_us);
    if (!(periods_s[i] > 0.0 && periods_s[i] <= kMaxPeriodS)) {
      return std::nullopt;
    }
    changes[i] = velocities_[i + 1].mps - velocities_[i].mps;
  }
  const Eigen::Array2d steady =
      0.5 * periods_s[1] * (changes[0] / periods_s[0] + changes[2] / periods_s[2]);
  const Eigen::Array2d jump = changes[1] - steady;
  const auto& [a, b, c, d] = velocities_;
  const Eigen::Array2d variance =
      2.25 * (b.variance + c.variance) + 0.25 * (a.variance + d.variance);
  const Eigen::Array2d beside = changes[0].abs().max(changes[2].abs());
  const bool is_jump = (jump.abs() > kMinJumpMps + kSigmas * variance.sqrt() &&
                        beside < kMaxShareBeside * jump.abs())
                           .any();
  return is_jump ? std::optional(c.stamp_us) : std::nullopt;
}

}  // namespace cremed
