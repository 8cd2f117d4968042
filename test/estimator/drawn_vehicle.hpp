// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Motions of several radars of one vehicle, drawn from their covariances.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "cremed/estimator/cost/shared_doppler.hpp"
#include "cremed/estimator/motion/ego_motion_estimator.hpp"

namespace cremed::simulation {

inline constexpr std::int64_t kDrawnStartUs = 1'700'000'000'000'000;

/// (m/s forward, m/s left, rad/s) of the vehicle at a time in s.
using Course = std::function<Eigen::Vector3d(double time_s)>;

inline double seconds_since_start(std::int64_t utime_us) {
  return static_cast<double>(utime_us - kDrawnStartUs) * 1e-6;
}

/// Pose of the vehicle at `end_us` in its frame at `start_us`.
inline Eigen::Vector3d true_motion(const Course& course, std::int64_t start_us,
                                   std::int64_t end_us) {
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

/// One radar and its accuracy.
struct DrawnRadar {
  std::int64_t period_us = 75'000;
  std::int64_t phase_us = 0;                ///< First scan.
  Eigen::Vector3d std{0.006, 0.02, 0.003};  ///< Of a motion, independent: m, m, rad.
};

/// A scan of one of the radars with its motion.
struct DrawnMotion {
  std::size_t radar = 0;
  EgoMotion motion;
  Eigen::Vector3d truth = Eigen::Vector3d::Zero();
};

/// A vehicle that drives a course. Its motions have errors of each radar's covariance, of the
/// body's velocity, and of the mounts' angles.
class DrawnVehicle {
 public:
  DrawnVehicle(Course course, std::vector<DrawnRadar> radars, const EgoMotionOptions& options,
               std::uint64_t seed)
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

  /// The next scan of any radar.
  DrawnMotion next() {
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

  [[nodiscard]] double time_s() const { return seconds_since_start(now_us_); }
  [[nodiscard]] Eigen::Vector3d truth(const EgoMotion& motion) const {
    return true_motion(course_, motion.utime_start_us, motion.utime_us);
  }

 private:
  [[nodiscard]] bool is_car() const { return options_.registration.degrees_of_freedom == 2; }
  double normal() { return normal_(random_); }

  void draw(DrawnMotion& drawn) {
    EgoMotion& motion = drawn.motion;
    const SharedErrorOptions& errors = options_.registration.shared_errors;
    const double dt_s =
        seconds_since_start(motion.utime_us) - seconds_since_start(motion.utime_start_us);
    const double rolling = rolling_part(drawn.truth, 0.0, dt_s);
    const double lateral_m = drawn.truth.x() * errors.mount_yaw_std_rad;
    Eigen::Matrix3d covariance = radars_[drawn.radar].std.cwiseAbs2().asDiagonal();
    covariance(0, 2) = covariance(2, 0) = 0.3 * std::sqrt(covariance(0, 0) * covariance(2, 2));
    const Eigen::Matrix3d root = covariance.llt().matrixL();
    Eigen::Vector3d seen = drawn.truth + root * Eigen::Vector3d(normal(), normal(), normal());
    seen.y() += mounts_rad_[drawn.radar] * drawn.truth.x();
    seen.x() += rolling * body_error_mps(motion) * dt_s;
    covariance(1, 1) += lateral_m * lateral_m;
    say(seen, covariance, motion);
    motion.covariance(0, 0) += std::pow(rolling * errors.velocity_std_mps * dt_s, 2);
    motion.status = drawn.truth.head<2>().norm() < options_.standstill_mps * dt_s
                        ? MotionStatus::standing_still
                        : MotionStatus::ok;
    motion.targets = 40;
  }

  /// As from a registration: with two degrees of freedom the best motion with y = 0.
  void say(const Eigen::Vector3d& seen, const Eigen::Matrix3d& covariance,
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

  /// Common to all radars, with a correlation time of about 0.3 s.
  double body_error_mps(const EgoMotion& motion) {
    constexpr double kStepS = 0.01;
    constexpr double kKept = 0.967;  // exp(-kStepS / 0.3 s)
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
                              : kKept * body_mps_.back() + std::sqrt(1 - kKept * kKept) * fresh);
    }
    double sum_mps = 0.0;
    for (std::size_t i = first; i <= last; ++i) {
      sum_mps += body_mps_[i];
    }
    return sum_mps / static_cast<double>(last - first + 1);
  }

  Course course_;
  std::vector<DrawnRadar> radars_;
  EgoMotionOptions options_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::vector<std::int64_t> next_us_;
  std::vector<std::int64_t> last_us_;  // 0: none yet.
  std::vector<double> mounts_rad_;
  std::vector<double> body_mps_;
  std::int64_t now_us_ = kDrawnStartUs;
};

inline EgoMotionOptions drawn_options(int degrees_of_freedom) {
  EgoMotionOptions options;
  options.registration.degrees_of_freedom = degrees_of_freedom;
  return options;
}

/// Up to five radars whose scans rarely coincide.
inline std::vector<DrawnRadar> drawn_radars(std::size_t count) {
  std::vector<DrawnRadar> radars = {{75'000, 0, {0.006, 0.02, 0.003}},
                                    {66'000, 41'000, {0.008, 0.015, 0.004}},
                                    {110'000, 13'000, {0.009, 0.03, 0.003}},
                                    {60'000, 29'000, {0.007, 0.02, 0.005}},
                                    {92'000, 57'000, {0.006, 0.025, 0.004}}};
  radars.resize(std::min(count, radars.size()));
  return radars;
}

inline Eigen::Vector3d straight_on(double /*time_s*/) { return {12.0, 0.0, 0.0}; }
inline Eigen::Vector3d in_bends(double time_s) { return {8.0, 0.0, 0.3 * std::sin(0.5 * time_s)}; }

}  // namespace cremed::simulation
