// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/scan/target_set.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed::test {

using simulation::kPeriodS;

inline constexpr double kWorldM = 400.0;

/// A radar of a car that drives on a circle among static objects.
struct CircleDrive {
  double speed_mps = 10.0;
  double yaw_rate_radps = 0.0;
  double doppler_factor = 1.0;  ///< Factor on Doppler: 0 if stuck.
  double pace = 1.0;            ///< Rate of the stamps over time.
  int things = 2000;            ///< Objects on kWorldM x kWorldM.
  double post_spacing_m = 0.0;  ///< Of guard rails on both sides of the x axis; 0: none.
  double kept = 0.8;            ///< Share of objects seen in a scan.
  Pose2 mount{3.4, 0.0, 0.0};
};

/// What the radar sees, scan by scan.
class CircleView {
 public:
  using Add = std::function<void(const TargetSet&, double yaw_rate_radps, std::int64_t stamp_us)>;

  /// Calls `add(targets, yaw_rate_radps, stamp_us)` for each scan.
  void go_on(const CircleDrive& drive, double duration_s, const Add& add);

 private:
  double uniform(double least, double most);
  double normal(double std);

  static std::vector<Eigen::Vector2d> things(int count);

  /// The world is periodic.
  static Eigen::Vector2d wrapped(const Eigen::Vector2d& way);

  TargetSet seen(const std::vector<Eigen::Vector2d>& world, const CircleDrive& drive);

  std::mt19937_64 random_{11};
  Eigen::Vector2d place_ = Eigen::Vector2d::Zero();
  double yaw_ = 0.0;
  std::int64_t stamp_us_ = 1'700'000'000'000'000;
};

}  // namespace cremed::test
