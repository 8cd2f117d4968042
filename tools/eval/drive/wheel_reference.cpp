// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/wheel_reference.hpp"

#include <cmath>
#include <vector>

#include "cremed/estimator/scan/stamps.hpp"
#include "tools/eval/csv_table.hpp"
#include "tools/eval/drive/time_bracket.hpp"

namespace cremed {
namespace {

/// One step of dead reckoning; speed and yaw rate change linearly from `a` to `b`.
Pose2 step(const Pose2& from, const Eigen::Vector2d& a, const Eigen::Vector2d& b, double dt_s) {
  const double yaw_rad = from.yaw_rad + 0.5 * dt_s * (a.y() + b.y());
  const double x_m = 0.5 * dt_s * (a.x() * std::cos(from.yaw_rad) + b.x() * std::cos(yaw_rad));
  const double y_m = 0.5 * dt_s * (a.x() * std::sin(from.yaw_rad) + b.x() * std::sin(yaw_rad));
  return {from.x_m + x_m, from.y_m + y_m, yaw_rad};
}

}  // namespace

WheelReference::WheelReference(std::istream& input, const WheelStd& std) : std_(std) {
  const CsvTable table(input);
  const std::size_t utime = table.column("utime");
  const std::size_t speed = table.column("speed_mps");
  const std::size_t yaw_rate = table.column("yaw_rate_radps");
  std::vector<std::int64_t> utime_us;
  std::vector<Pose2> poses;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    utime_us.push_back(table.utime_us(row, utime));
    rates_.emplace_back(table.finite(row, speed), table.finite(row, yaw_rate));
    poses.push_back(row == 0 ? Pose2{}
                             : step(poses.back(), rates_[row - 1], rates_[row],
                                    seconds_between(utime_us[row - 1], utime_us[row])));
  }
  dead_reckoning_ = TrueTrajectory(std::move(utime_us), std::move(poses));
}

std::optional<Eigen::Vector2d> WheelReference::rates(std::int64_t utime_us) const {
  if (!dead_reckoning_.at(utime_us)) {
    return std::nullopt;
  }
  const auto place = bracket(dead_reckoning_.utime_us(), utime_us);
  return (1.0 - place->share) * rates_[place->left] + place->share * rates_[place->right];
}

}  // namespace cremed
