// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "tools/eval/drive/true_trajectory.hpp"
#include "tools/simulate/simulation.hpp"

namespace cremed::soak {

inline constexpr std::array<std::string_view, 4> kScenarios{"straight", "bends", "stop-and-go",
                                                            "city"};

/// One drive with truth.
struct SoakDrive {
  SoakDrive(std::size_t scenario_index, const std::vector<RadarConfiguration>& radars,
            const SimulationOptions& options)
      : scenario(scenario_index),
        simulation(*find_scenario(kScenarios[scenario_index]), radars, options) {}

  [[nodiscard]] VehicleState at(std::int64_t true_us) const {
    return simulation.scene().course().at(simulation.scene().seconds(true_us));
  }

  /// Pose at `end_us` in the vehicle's frame at `start_us`: (x_m, y_m, yaw_rad).
  [[nodiscard]] Eigen::Vector3d motion(std::int64_t start_us, std::int64_t end_us) const {
    return motion_between(at(start_us).pose, at(end_us).pose);
  }

  std::size_t scenario;  ///< Index of kScenarios.
  Simulation simulation;
};

}  // namespace cremed::soak
