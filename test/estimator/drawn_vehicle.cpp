// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "test/estimator/drawn_vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "cremed/estimator/cost/driving_share.hpp"

namespace cremed::simulation {

double seconds_since_start(std::int64_t utime_us) {
  return static_cast<double>(utime_us - kDrawnStartUs) * 1e-6;
}

Eigen::Vector3d true_motion(const Course& course, std::int64_t start_us, std::int64_t end_us) {
  constexpr int kSteps = 20;
  const double start_s = seconds_since_start(start_us);
  const double step_s = (seconds_since_start(end_us) - start_s) / kSteps;
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::Vector3d change = step_s * course(start_s + (i + 0.5) * step_s);
    pose.head<2>() += Eigen::Rotation2Dd(pose.z() + 0.5 * change.z()) * change.head<2>();
    pose.z() += change.z();
  }
  return pose;
}

DrawnVehicle::DrawnVehicle(Course course, std::vector<DrawnRadar> radars,
                           const EgoMotionOptions& options, std::uint64_t seed)
    : course_(std::move(course)),
      radars_(std::move(radars)),
      options_(options),
      random_(seed),
      last_us_(radars_.size(), 0) {
  const double std_rad = options.registration.shared_errors.mount_yaw_std_rad;
  for (const DrawnRadar& radar : radars_) {
    next_us_.push_back(kDrawnStartUs + radar.phase_us);
    mounts_rad_.push_back(std_rad * normal());
  }
}

DrawnMotion DrawnVehicle::next() {
  DrawnMotion drawn;
  drawn.radar = static_cast<std::size_t>(std::min_element(next_us_.begin(), next_us_.end()) -
                                         next_us_.begin());
  std::int64_t& next_us = next_us_[drawn.radar];
  std::int64_t& last_us = last_us_[drawn.radar];
  drawn.motion.utime_us = now_us_ = next_us;
  drawn.motion.utime_start_us = last_us == 0 ? next_us : last_us;
  if (last_us != 0) {
    drawn.truth = true_motion(course_, last_us, next_us);
    draw(drawn);
  }
  last_us = next_us;
  next_us += radars_[drawn.radar].period_us;
  return drawn;
}

double DrawnVehicle::time_s() const { return seconds_since_start(now_us_); }

Eigen::Vector3d DrawnVehicle::truth(const EgoMotion& motion) const {
  return true_motion(course_, motion.utime_start_us, motion.utime_us);
}

bool DrawnVehicle::is_car() const { return options_.registration.degrees_of_freedom == 2; }

double DrawnVehicle::normal() { return normal_(random_); }

void DrawnVehicle::draw(DrawnMotion& drawn) {
  EgoMotion& motion = drawn.motion;
  const SharedErrorOptions& errors = options_.registration.shared_errors;
  const double dt_s =
      seconds_since_start(motion.utime_us) - seconds_since_start(motion.utime_start_us);
  const double driving = driving_share(speed_beyond_noise_mps(drawn.truth, 0.0, dt_s));
  const double lateral_m = drawn.truth.x() * errors.mount_yaw_std_rad;
  Eigen::Matrix3d covariance = radars_[drawn.radar].std.cwiseAbs2().asDiagonal();
  covariance(0, 2) = covariance(2, 0) = 0.3 * std::sqrt(covariance(0, 0) * covariance(2, 2));
  const Eigen::Matrix3d root = covariance.llt().matrixL();
  Eigen::Vector3d seen = drawn.truth + root * Eigen::Vector3d(normal(), normal(), normal());
  seen.y() += mounts_rad_[drawn.radar] * drawn.truth.x();
  seen.x() += driving * body_error_mps(motion) * dt_s;
  covariance(1, 1) += lateral_m * lateral_m;
  say(seen, covariance, motion);
  motion.covariance(0, 0) += std::pow(driving * errors.velocity_std_mps * dt_s, 2);
  motion.status = drawn.truth.head<2>().norm() < options_.standstill_mps * dt_s
                      ? MotionStatus::standing_still
                      : MotionStatus::ok;
  motion.targets = 40;
}

void DrawnVehicle::say(const Eigen::Vector3d& seen, const Eigen::Matrix3d& covariance,
                       EgoMotion& motion) const {
  motion.motion = seen;
  motion.covariance = covariance;
  if (is_car()) {
    const Eigen::Matrix3d h = covariance.inverse();
    Eigen::Matrix2d block;
    block << h(0, 0), h(0, 2), h(2, 0), h(2, 2);
    const Eigen::Matrix2d inverse = block.inverse();
    const Eigen::Vector2d shift = inverse * Eigen::Vector2d(h(0, 1), h(2, 1)) * seen.y();
    motion.motion = {seen.x() + shift.x(), 0.0, seen.z() + shift.y()};
    motion.covariance.setZero();
    motion.covariance(0, 0) = inverse(0, 0);
    motion.covariance(0, 2) = motion.covariance(2, 0) = inverse(0, 1);
    motion.covariance(2, 2) = inverse(1, 1);
  }
}

double DrawnVehicle::body_error_mps(const EgoMotion& motion) {
  constexpr double kStepS = 0.01;
  constexpr double kCorrelationPerStep = 0.967;  // exp(-kStepS / 0.3 s)
  const double std_mps = options_.registration.shared_errors.velocity_std_mps;
  const auto index = [](std::int64_t utime_us) {
    return static_cast<std::size_t>(seconds_since_start(utime_us) / kStepS);
  };
  const std::size_t first = index(motion.utime_start_us);
  const std::size_t last = index(motion.utime_us);
  while (body_mps_.size() <= last) {
    const double fresh = std_mps * normal();
    body_mps_.push_back(body_mps_.empty()
                            ? fresh
                            : kCorrelationPerStep * body_mps_.back() +
                                  std::sqrt(1 - kCorrelationPerStep * kCorrelationPerStep) * fresh);
  }
  double sum_mps = 0.0;
  for (std::size_t i = first; i <= last; ++i) {
    sum_mps += body_mps_[i];
  }
  return sum_mps / static_cast<double>(last - first + 1);
}

EgoMotionOptions drawn_options(int degrees_of_freedom) {
  EgoMotionOptions options;
  options.registration.degrees_of_freedom = degrees_of_freedom;
  return options;
}

std::vector<DrawnRadar> drawn_radars(std::size_t count) {
  std::vector<DrawnRadar> radars = {{75'000, 0, {0.006, 0.02, 0.003}},
                                    {66'000, 41'000, {0.008, 0.015, 0.004}},
                                    {110'000, 13'000, {0.009, 0.03, 0.003}},
                                    {60'000, 29'000, {0.007, 0.02, 0.005}},
                                    {92'000, 57'000, {0.006, 0.025, 0.004}}};
  radars.resize(std::min(count, radars.size()));
  return radars;
}

Eigen::Vector3d straight_on(double /*time_s*/) { return {12.0, 0.0, 0.0}; }
Eigen::Vector3d in_bends(double time_s) { return {8.0, 0.0, 0.3 * std::sin(0.5 * time_s)}; }

}  // namespace cremed::simulation
