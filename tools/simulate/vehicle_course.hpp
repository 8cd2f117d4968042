// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "cremed/estimator/scan/pose2.hpp"

namespace cremed {

/// Speeds and curvature at the end of a leg, reached smoothly from those at its beginning.
struct CourseLeg {
  double duration_s = 0.0;      ///< A multiple of VehicleCourse::kStepS.
  double speed_mps = 0.0;       ///< Along x, negative when reversing.
  double curvature_1pm = 0.0;   ///< Yaw rate over speed, positive to the left.
  double side_speed_mps = 0.0;  ///< Of the rear axle to the left, in a skid.
};

/// The legs are repeated until the time is over.
struct CoursePlan {
  double start_speed_mps = 0.0;
  std::vector<CourseLeg> legs;
  double start_curvature_1pm = 0.0;
  /// Angle by which the rear axle slips to the outside, per centripetal acceleration; rad s^2/m.
  double slip_per_lateral_acceleration = 0.0;
};

/// The vehicle at one moment.
struct VehicleState {
  Pose2 pose;                   ///< Centre of the rear axle in the world.
  double speed_mps = 0.0;       ///< Along x.
  double side_speed_mps = 0.0;  ///< Along y; 0 unless it skids.
  double yaw_rate_radps = 0.0;
  double distance_m = 0.0;  ///< Path length since the start, forwards and backwards.
};

/// How a car drives a plan, starting at the world's origin along x.
class VehicleCourse {
 public:
  static constexpr double kStepS = 0.01;

  /// Throws std::invalid_argument if the plan has no leg or a leg is not a multiple of the step.
  VehicleCourse(const CoursePlan& plan, double least_duration_s);

  /// Times outside 0 .. duration_s() are clamped.
  [[nodiscard]] VehicleState at(double time_s) const;

  /// The states at 0, kStepS, 2 kStepS ...; the last is at or after the given duration.
  [[nodiscard]] const std::vector<VehicleState>& steps() const { return steps_; }
  [[nodiscard]] double duration_s() const;

 private:
  struct Leg {
    double start_s;
    CourseLeg from;  ///< The one before.
    CourseLeg to;
    double slip_per_lateral_acceleration;

    /// Speeds and yaw rate at a time since the start.
    [[nodiscard]] VehicleState at(double time_s) const;
  };

  static VehicleState advanced(const Leg& leg, const VehicleState& from, double from_s,
                               double step_s);
  void drive_leg(const Leg& leg);

  std::vector<Leg> legs_;
  std::vector<std::size_t> leg_of_step_;  ///< The leg that follows each of steps_.
  std::vector<VehicleState> steps_;
};

}  // namespace cremed
