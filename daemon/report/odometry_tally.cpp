// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/report/odometry_tally.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

/// Healthy recorded drives have 3 % at most (0796), the sign of one of two radars wrong in the
/// simulated town 22 %.
constexpr double kMaxShare = 0.1;
/// A second or two of scans: at a start radars may disagree for some tenths of a second.
constexpr std::uint64_t kMinStates = 100;

/// With the mount of the front radar turned by pi all of five recorded drives is in reverse; as
/// mounted 0 % of them, and at most 0.2 % of 22 simulated drives beyond 1 m. The scenario
/// "reversing", which is true, has 79 %.
constexpr double kMinReversed = 0.95;
/// Backing out of a yard is shorter or slower.
constexpr double kMinReversedM = 50.0;
constexpr double kWalkingPaceMps = 2.0;

}  // namespace

void OdometryTally::on_odometry(const Odometry& odometry) {
  ++count_[static_cast<std::size_t>(odometry.status)];
  if (odometry.is_usable()) {
    const double length_m = odometry.motion.head<2>().norm();
    driven_m_ += length_m;
    reversed_m_ += odometry.motion.x() < 0.0 ? length_m : 0.0;
    highest_speed_mps_ = std::max(highest_speed_mps_, std::abs(odometry.twist.x()));
  }
}

std::optional<Finding> unusable_odometry(const OdometryTally& tally, std::size_t radars) {
  const std::uint64_t usable =
      tally.count(OdometryStatus::ok) + tally.count(OdometryStatus::standing_still);
  const std::uint64_t unusable =
      tally.count(OdometryStatus::ambiguous) + tally.count(OdometryStatus::lost);
  const double share = static_cast<double>(unusable) /
                       static_cast<double>(std::max<std::uint64_t>(1, usable + unusable));
  if (usable + unusable < kMinStates || share <= kMaxShare) {
    return std::nullopt;
  }
  return Finding{Severity::warning,
                 concat({"the odometry was ambiguous or lost for ", tenths(100.0 * share),
                         " % of the time: its ",
                         radars == 1 ? "radar contradicts itself"
                                     : "radars contradict each other, or themselves"}),
                 "check mount, type and the keys that invert a sign of every radar; "
                 "`cremed-report` shows when, and which were left out"};
}

std::optional<Finding> reversed_odometry(const OdometryTally& tally, std::size_t radars) {
  if (radars != 1 || tally.driven_m() < kMinReversedM ||
      tally.reversed_m() < kMinReversed * tally.driven_m() ||
      tally.highest_speed_mps() < kWalkingPaceMps) {
    return std::nullopt;
  }
  return Finding{Severity::note,
                 concat({"the vehicle drove backwards for ",
                         tenths(100.0 * tally.reversed_m() / tally.driven_m()), " % of ",
                         tenths(tally.driven_m()), " m, at up to ",
                         tenths(tally.highest_speed_mps()), " m/s"}),
                 "a single radar cannot tell that from a mount turned by pi: if it drove forwards, "
                 "turn mount.yaw_rad by pi, or correct the sign of its Doppler"};
}

std::vector<Finding> odometry_findings(const OdometryTally& tally, std::size_t radars) {
  std::vector<Finding> findings;
  for (const auto& finding : {unusable_odometry(tally, radars), reversed_odometry(tally, radars)}) {
    if (finding) {
      findings.push_back(*finding);
    }
  }
  return findings;
}

}  // namespace cremed
