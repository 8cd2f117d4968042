// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "tools/simulate/road.hpp"
#include "tools/simulate/scenario.hpp"
#include "tools/simulate/slow_error.hpp"
#include "tools/simulate/told_motion.hpp"
#include "tools/simulate/traffic.hpp"
#include "tools/simulate/vehicle_course.hpp"
#include "tools/simulate/world.hpp"

namespace cremed {

/// Everything visible over time: the drive, static objects and other cars.
class Scene {
 public:
  /// `body_velocity_std_mps`: see SimulationOptions.
  Scene(const Scenario& scenario, double duration_s, std::int64_t start_us, std::uint64_t seed,
        double body_velocity_std_mps);
  Scene(const Scene&) = delete;  // Its parts refer to each other.
  Scene& operator=(const Scene&) = delete;

  [[nodiscard]] double seconds(std::int64_t stamp_us) const {
    return static_cast<double>(stamp_us - start_us_) * 1e-6;
  }
  [[nodiscard]] std::int64_t start_us() const { return start_us_; }
  [[nodiscard]] std::int64_t end_us() const { return end_us_; }
  [[nodiscard]] const VehicleCourse& course() const { return course_; }
  /// The vehicle's body with the radars: it pitches on its springs and rolls in a skid, so its
  /// velocity differs from the rear axle's.
  [[nodiscard]] VehicleState body(double time_s) const;
  /// The motion that the vehicle sends to its sensors.
  [[nodiscard]] ToldMotion told_motion(double time_s) const { return vehicle_bus_.at(time_s); }
  [[nodiscard]] const World& world() const { return world_; }
  [[nodiscard]] const Traffic& traffic() const { return traffic_; }

 private:
  std::int64_t start_us_;
  std::int64_t end_us_;
  VehicleCourse course_;
  Road road_;
  World world_;
  Traffic traffic_;
  SlowError body_speed_;
  SlowError body_side_speed_;
  VehicleBus vehicle_bus_;
};

}  // namespace cremed
