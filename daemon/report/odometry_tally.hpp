// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/output/odometry_sink.hpp"
#include "daemon/report/finding.hpp"

namespace cremed {

/// Counts the odometry's states by their status, and how far it went.
class OdometryTally final : public OdometrySink {
 public:
  void on_odometry(const Odometry& odometry) override;
  [[nodiscard]] std::uint64_t count(OdometryStatus status) const {
    return count_[static_cast<std::size_t>(status)];
  }
  /// The length of the usable part, and that of it in reverse.
  [[nodiscard]] double driven_m() const { return driven_m_; }
  [[nodiscard]] double reversed_m() const { return reversed_m_; }
  [[nodiscard]] double highest_speed_mps() const { return highest_speed_mps_; }

 private:
  std::array<std::uint64_t, kOdometryStatusCount> count_{};
  double driven_m_ = 0.0;
  double reversed_m_ = 0.0;
  double highest_speed_mps_ = 0.0;
};

/// A warning if the odometry of so many radars was not to be believed for a large part of the
/// drive. The radars' statuses do not tell: they are of its end.
std::optional<Finding> unusable_odometry(const OdometryTally& tally, std::size_t radars);

/// A note if it reversed for nearly all of a drive, as it does by a single radar whose mount is
/// turned by pi: nothing else that this radar sees contradicts that. Several contradict it.
std::optional<Finding> reversed_odometry(const OdometryTally& tally, std::size_t radars);

/// Both.
std::vector<Finding> odometry_findings(const OdometryTally& tally, std::size_t radars);

}  // namespace cremed
