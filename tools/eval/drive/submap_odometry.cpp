// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/submap_odometry.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "tools/eval/plane_motion.hpp"

namespace cremed {
namespace {

constexpr int kGrids = 4;
/// One point has no distribution.
constexpr int kLeastPoints = 2;

constexpr int kMaxIterations = 30;
constexpr double kStepTolerance = 1e-5;

/// Static targets, seen from the vehicle's pose at the sweep's time.
std::vector<UncertainPoint> standing_points(const Sweep& sweep, const KellnerVelocity& velocity) {
  std::vector<UncertainPoint> points;
  for (const std::size_t i : velocity.standing) {
    const SweepTarget& target = sweep.targets[i];
    const Eigen::Vector3d back = -target.age_s * velocity.twist;
    const Eigen::Matrix2d turn = rotation_matrix(back.z());
    points.push_back({turn * target.position_m + back.head<2>(),
                      turn * target.covariance_m2 * turn.transpose()});
  }
  return points;
}

std::vector<UncertainPoint> placed(const std::vector<UncertainPoint>& points, const Pose2& pose) {
  const Eigen::Matrix2d turn = rotation_matrix(pose.yaw_rad);
  std::vector<UncertainPoint> result;
  result.reserve(points.size());
  for (const UncertainPoint& point : points) {
    result.push_back({turn * point.position_m + Eigen::Vector2d(pose.x_m, pose.y_m),
                      turn * point.covariance_m2 * turn.transpose()});
  }
  return result;
}

/// Systematic error of the velocity by mounts, offsets and azimuths, not the noise of targets. With
/// a yaw rate of 0.02 rad/s its error turns the path (0061: 0.040 instead of 0.020 deg/m).
const Eigen::Vector3d kTwistStd(0.1, 0.1, 0.1);  // m/s, m/s, rad/s

/// The velocity's motion as a measurement in the frame of the poses.
struct Expectation {
  Pose2 pose;
  Eigen::Matrix3d information;
};

Expectation expectation(const Pose2& before, const Eigen::Vector3d& motion, double dt_s) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = rotation_matrix(before.yaw_rad);
  const Eigen::Vector3d information = (dt_s * kTwistStd).cwiseAbs2().cwiseInverse();
  return {moved(before, motion), turn * information.asDiagonal() * turn.transpose()};
}

struct Match {
  Pose2 pose;
  NdtMap::Equations equations;
};

Match matched(const NdtMap& map, const std::vector<UncertainPoint>& points,
              const Expectation& expected) {
  Match match;
  Pose2 pose = expected.pose;
  for (int i = 0; i < kMaxIterations; ++i) {
    const Eigen::Vector3d off(expected.pose.x_m - pose.x_m, expected.pose.y_m - pose.y_m,
                              expected.pose.yaw_rad - pose.yaw_rad);
    match = {pose, {expected.information, expected.information * off}};
    const Eigen::Vector2d centre(pose.x_m, pose.y_m);
    for (const UncertainPoint& point : placed(points, pose)) {
      map.add_point(point, centre, match.equations);
    }
    const Eigen::Vector3d step = match.equations.information.ldlt().solve(match.equations.right);
    if (!step.allFinite() || step.norm() < kStepTolerance) {
      break;
    }
    pose = {pose.x_m + step.x(), pose.y_m + step.y(), pose.yaw_rad + step.z()};
  }
  return match;
}

}  // namespace

/// Index of the cell of a point.
std::int64_t NdtMap::key(int grid, const Eigen::Vector2d& point_m) const {
  const Eigen::Vector2d shift(grid % 2 == 0 ? 0.0 : 0.5, grid < 2 ? 0.0 : 0.5);
  const Eigen::Vector2d cell = point_m / cell_m_ + shift;
  const auto column = static_cast<std::int64_t>(std::floor(cell.x()));
  const auto row = static_cast<std::int64_t>(std::floor(cell.y()));
  return ((column + (std::int64_t{1} << 24)) << 32 | (row + (std::int64_t{1} << 24))) * kGrids +
         grid;
}

void NdtMap::add(const UncertainPoint& point, int count) {
  for (int grid = 0; grid < kGrids; ++grid) {
    const auto cell = cells_.try_emplace(key(grid, point.position_m)).first;
    cell->second.points += count;
    cell->second.sum_m += count * point.position_m;
    cell->second.squares_m2 +=
        count * (point.position_m * point.position_m.transpose() + point.covariance_m2);
    if (cell->second.points == 0) {
      cells_.erase(cell);
    }
  }
}

void NdtMap::add_point(const UncertainPoint& point, const Eigen::Vector2d& centre_m,
                       Equations& equations) const {
  const Eigen::Vector2d arm = point.position_m - centre_m;
  Eigen::Matrix<double, 2, 3> by_motion;
  by_motion << 1.0, 0.0, -arm.y(), 0.0, 1.0, arm.x();
  for (int grid = 0; grid < kGrids; ++grid) {
    const auto found = cells_.find(key(grid, point.position_m));
    if (found == cells_.end() || found->second.points < kLeastPoints) {
      continue;
    }
    const Cell& cell = found->second;
    const Eigen::Vector2d mean = cell.sum_m / cell.points;
    const Eigen::Matrix2d covariance =
        cell.squares_m2 / cell.points - mean * mean.transpose() + point.covariance_m2;
    const Eigen::Matrix2d information = covariance.inverse();
    const Eigen::Vector2d error = mean - point.position_m;
    const double likelihood = std::exp(-0.5 * error.dot(information * error)) / kGrids;
    equations.information += likelihood * by_motion.transpose() * information * by_motion;
    equations.right += likelihood * by_motion.transpose() * information * error;
  }
}

void SubmapOdometry::add_to_map(const std::vector<UncertainPoint>& placed_points) {
  for (const UncertainPoint& point : placed_points) {
    map_.add(point);
  }
  sweeps_.push_back(placed_points);
  if (sweeps_.size() > options_.sweeps) {
    for (const UncertainPoint& point : sweeps_.front()) {
      map_.add(point, -1);
    }
    sweeps_.pop_front();
  }
}

SubmapOdometry::Result SubmapOdometry::update(const Sweep& sweep, const KellnerVelocity& velocity,
                                              const Eigen::Vector3d& motion, double dt_s) {
  const std::vector<UncertainPoint> points = standing_points(sweep, velocity);
  const Match match = matched(map_, points, expectation(pose_, motion, dt_s));
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = rotation_matrix(-pose_.yaw_rad);
  Result result{motion_between(pose_, match.pose),
                turn * match.equations.information.inverse() * turn.transpose()};
  pose_ = match.pose;
  add_to_map(placed(points, pose_));
  return result;
}

}  // namespace cremed
