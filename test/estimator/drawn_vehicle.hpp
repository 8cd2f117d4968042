// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Simulated motions of several radars of one vehicle, drawn from their covariances.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/motion/ego_motion_estimator.hpp"

namespace cremed::simulation {

inline constexpr std::int64_t kDrawnStartUs = 1'700'000'000'000'000;

/// (m/s forward, m/s left, rad/s) of the vehicle at a time in s.
using Course = std::function<Eigen::Vector3d(double time_s)>;

double seconds_since_start(std::int64_t utime_us);

/// Pose of the vehicle at `end_us` in its frame at `start_us`.
Eigen::Vector3d true_motion(const Course& course, std::int64_t start_us, std::int64_t end_us);

/// One radar and its noise.
struct DrawnRadar {
  std::int64_t period_us = 75'000;
  std::int64_t phase_us = 0;                ///< First scan.
  Eigen::Vector3d std{0.006, 0.02, 0.003};  ///< Independent noise of a motion: m, m, rad.
};

/// A scan of one of the radars with its motion.
struct DrawnMotion {
  std::size_t radar = 0;
  EgoMotion motion;
  Eigen::Vector3d truth = Eigen::Vector3d::Zero();
};

/// A vehicle that drives a course. The errors of its motions are each radar's noise, the velocity
/// of the body, and the yaw error of each mount.
class DrawnVehicle {
 public:
  DrawnVehicle(Course course, std::vector<DrawnRadar> radars, const EgoMotionOptions& options,
               std::uint64_t seed);

  /// The next scan of any radar.
  DrawnMotion next();

  [[nodiscard]] double time_s() const;
  [[nodiscard]] Eigen::Vector3d truth(const EgoMotion& motion) const;

 private:
  [[nodiscard]] bool is_car() const;
  double normal();

  void draw(DrawnMotion& drawn);

  /// As by a registration: with two degrees of freedom the best motion with y = 0.
  void say(const Eigen::Vector3d& seen, const Eigen::Matrix3d& covariance, EgoMotion& motion) const;

  /// Velocity of the body, common to all radars, with a correlation time of 0.3 s.
  double body_error_mps(const EgoMotion& motion);

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

EgoMotionOptions drawn_options(int degrees_of_freedom);

/// Up to five radars whose scans rarely coincide.
std::vector<DrawnRadar> drawn_radars(std::size_t count);

Eigen::Vector3d straight_on(double time_s);
Eigen::Vector3d in_bends(double time_s);

}  // namespace cremed::simulation
