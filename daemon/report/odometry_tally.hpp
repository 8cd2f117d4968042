// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "daemon/output/odometry_sink.hpp"
#include "daemon/report/finding.hpp"

namespace cremed {

/// Counts the odometry's states by their status.
class OdometryTally final : public OdometrySink {
 public:
  void on_odometry(const Odometry& odometry) override {
    ++count_[static_cast<std::size_t>(odometry.status)];
  }
  [[nodiscard]] std::uint64_t count(OdometryStatus status) const {
    return count_[static_cast<std::size_t>(status)];
  }

 private:
  std::array<std::uint64_t, kOdometryStatusCount> count_{};
};

/// A warning if the odometry was not to be believed for a large part of the drive. The radars'
/// statuses do not tell: they are of its end.
std::optional<Finding> unusable_odometry(const OdometryTally& tally);

}  // namespace cremed
