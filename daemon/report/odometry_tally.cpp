// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/report/odometry_tally.hpp"

#include <algorithm>

#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

/// Healthy recorded drives have 3 % at most (0796), the sign of one of two radars wrong in the
/// simulated town 22 %.
constexpr double kMaxShare = 0.1;
/// A second or two of scans: at a start radars may disagree for some tenths of a second.
constexpr std::uint64_t kMinStates = 100;

}  // namespace

std::optional<Finding> unusable_odometry(const OdometryTally& tally) {
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
                         " % of the time: its radars contradict each other, or themselves"}),
                 "check mount, type and the keys that invert a sign of every radar; "
                 "`cremed-report` shows when, and which were left out"};
}

}  // namespace cremed
