// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/true_trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "tools/eval/csv_table.hpp"

namespace cremed {
namespace {

double wrap(double angle_rad) { return std::remainder(angle_rad, 2.0 * std::numbers::pi); }

void check_order(const std::vector<std::int64_t>& utime_us) {
  const auto late = std::ranges::adjacent_find(utime_us, std::greater_equal<>());
  if (late != utime_us.end()) {
    throw std::runtime_error("row " + std::to_string(late - utime_us.begin() + 2) +
                             ": utime does not increase");
  }
}

std::vector<TimeSpan> gaps_in(const std::vector<std::int64_t>& utime_us) {
  const std::int64_t longest_us = longest_step_us(utime_us);
  std::vector<TimeSpan> gaps;
  for (std::size_t i = 1; i < utime_us.size(); ++i) {
    if (utime_us[i] - utime_us[i - 1] > longest_us) {
      gaps.push_back({utime_us[i - 1], utime_us[i]});
    }
  }
  return gaps;
}

/// How well the path runs along the vehicle's axis, forward or back, if yaw is in this unit: 1 if
/// it does.
double mean_cosine_of_slip(const std::vector<Pose2>& poses, double rad_per_unit) {
  double sum = 0.0;
  double way_m = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const double dx = poses[i].x_m - poses[i - 1].x_m;
    const double dy = poses[i].y_m - poses[i - 1].y_m;
    const double yaw_rad = poses[i - 1].yaw_rad * rad_per_unit;
    sum += std::abs(dx * std::cos(yaw_rad) + dy * std::sin(yaw_rad));
    way_m += std::hypot(dx, dy);
  }
  return way_m > 0.0 ? sum / way_m : 1.0;
}

void check_unit(const std::vector<Pose2>& poses) {
  const double as_radians = mean_cosine_of_slip(poses, 1.0);
  const double as_degrees = mean_cosine_of_slip(poses, std::numbers::pi / 180.0);
  if (as_degrees > 0.95 && as_degrees > as_radians + 0.05) {
    throw std::runtime_error(
        "yaw_rad: is it in degrees? So it would be the course of the path; radians are expected");
  }
}

/// Odometry has columns of these names too.
void check_kind(const CsvTable& table) {
  if (table.has_column("status")) {
    throw std::runtime_error("this is odometry, not truth; ODOMETRY comes before TRUTH");
  }
  if (table.rows() == 0) {
    throw std::runtime_error("no row but the header");
  }
}

}  // namespace

TrueTrajectory::TrueTrajectory(std::istream& input) {
  const CsvTable table(input);
  check_kind(table);
  const std::size_t utime = table.column("utime");
  const std::size_t x = table.column("x_m");
  const std::size_t y = table.column("y_m");
  const std::size_t yaw = table.column("yaw_rad");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    utime_us_.push_back(table.utime_us(row, utime));
    poses_.push_back({table.finite(row, x), table.finite(row, y), table.finite(row, yaw)});
  }
  check_order(utime_us_);
  check_unit(poses_);
  gaps_ = gaps_in(utime_us_);
}

TrueTrajectory::TrueTrajectory(std::vector<std::int64_t> utime_us, std::vector<Pose2> poses,
                               std::vector<TimeSpan> gaps)
    : utime_us_(std::move(utime_us)), poses_(std::move(poses)), gaps_(std::move(gaps)) {
  check_order(utime_us_);
}

TrueTrajectory::TrueTrajectory(std::vector<std::int64_t> utime_us, std::vector<Pose2> poses)
    : TrueTrajectory(std::move(utime_us), std::move(poses), {}) {
  gaps_ = gaps_in(utime_us_);
}

bool TrueTrajectory::touches_gap(std::int64_t start_us, std::int64_t end_us) const {
  const auto gap = std::ranges::upper_bound(gaps_, start_us, {}, &TimeSpan::end_us);
  return gap != gaps_.end() && gap->begin_us < end_us;
}

std::optional<Pose2> TrueTrajectory::at(std::int64_t utime_us) const {
  const auto place = bracket(utime_us_, utime_us);
  if (!place || touches_gap(utime_us, utime_us)) {
    return std::nullopt;
  }
  const double share = place->share;
  const Pose2& a = poses_[place->left];
  const Pose2& b = poses_[place->right];
  return Pose2{a.x_m + share * (b.x_m - a.x_m), a.y_m + share * (b.y_m - a.y_m),
               a.yaw_rad + share * wrap(b.yaw_rad - a.yaw_rad)};
}

std::optional<Eigen::Vector3d> TrueTrajectory::motion(std::int64_t start_us,
                                                      std::int64_t end_us) const {
  const auto start = at(start_us);
  const auto end = at(end_us);
  if (!start || !end) {
    return std::nullopt;
  }
  return motion_between(*start, *end);
}

std::optional<Eigen::Vector3d> TrueTrajectory::unbroken_motion(std::int64_t start_us,
                                                               std::int64_t end_us) const {
  return touches_gap(start_us, end_us) ? std::nullopt : motion(start_us, end_us);
}

Eigen::Vector3d motion_between(const Pose2& start, const Pose2& end) {
  const double c = std::cos(start.yaw_rad);
  const double s = std::sin(start.yaw_rad);
  const double dx = end.x_m - start.x_m;
  const double dy = end.y_m - start.y_m;
  return {c * dx + s * dy, -s * dx + c * dy, wrap(end.yaw_rad - start.yaw_rad)};
}

Pose2 moved(const Pose2& start, const Eigen::Vector3d& motion) {
  const double c = std::cos(start.yaw_rad);
  const double s = std::sin(start.yaw_rad);
  return {start.x_m + c * motion.x() - s * motion.y(), start.y_m + s * motion.x() + c * motion.y(),
          start.yaw_rad + motion.z()};
}

}  // namespace cremed
