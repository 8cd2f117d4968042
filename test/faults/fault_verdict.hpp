// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <numeric>
#include <string>

#include "test/faults/drive_figures.hpp"

namespace cremed::test {

/// What is demanded with a systematic fault, and whether it holds.
struct FaultVerdict {
  static constexpr double kMaxBeyondShare = 0.02;  ///< Of the usable rows.
  static constexpr double kMaxNamedAfterS = 5.0;
  static constexpr double kMaxRecoveryS = 2.0;

  bool is_right = true;         ///< Few usable rows are beyond 5 sigma.
  bool is_odom_right = true;    ///< No pose since the start is.
  bool is_guilty_named = true;  ///< Each guilty radar, unless its error is learned or all err.
  bool is_no_innocent_named = true;
  bool is_recovered = true;    ///< Soon after the fault's end.
  bool is_cause_right = true;  ///< If a cause is named for a guilty radar, it is its cause.

  /// A letter for each demand that does not hold.
  [[nodiscard]] std::string failures() const {
    return std::string(is_right ? "" : "B") + (is_odom_right ? "" : "O") +
           (is_guilty_named ? "" : "U") + (is_no_innocent_named ? "" : "I") +
           (is_recovered ? "" : "R") + (is_cause_right ? "" : "C");
  }
};

inline FaultVerdict verdict_of(const FaultCase& fault, const DriveFigures& figures) {
  FaultVerdict verdict;
  verdict.is_right = figures.beyond_share() <= FaultVerdict::kMaxBeyondShare;
  verdict.is_odom_right = figures.odom_sigmas <= DriveJudge::kMaxSigma;
  bool are_all_guilty = true;
  for (std::size_t i = 0; i < figures.radars.size(); ++i) {
    const auto& named_after_s = figures.radars[i].named_after_s;
    const bool is_guilty = (fault.guilty >> i & 1U) != 0;
    are_all_guilty = are_all_guilty && is_guilty;
    if (is_guilty) {
      verdict.is_guilty_named = verdict.is_guilty_named && named_after_s &&
                                *named_after_s <= FaultVerdict::kMaxNamedAfterS;
      const auto& causes = figures.radars[i].causes;
      const int named = std::accumulate(causes.begin(), causes.end(), 0);
      verdict.is_cause_right =
          verdict.is_cause_right &&
          (fault.changes || named == causes.at(static_cast<std::size_t>(fault.cause_of(i))));
    } else {
      verdict.is_no_innocent_named = verdict.is_no_innocent_named && !named_after_s;
    }
  }
  // What all radars share, no radar tells: the odometry must not be ok.
  if (are_all_guilty || (fault.may_be_learned && verdict.is_right)) verdict.is_guilty_named = true;
  if (fault.ends()) {
    verdict.is_recovered = figures.recovery_s && *figures.recovery_s <= FaultVerdict::kMaxRecoveryS;
  }
  return verdict;
}

}  // namespace cremed::test
