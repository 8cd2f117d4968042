// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>
#include <vector>

#include "tools/simulate/traffic.hpp"
#include "tools/simulate/vehicle_course.hpp"
#include "tools/simulate/world.hpp"

namespace cremed {

/// Injected faults.
struct FaultOptions {
  double frame_loss = 0.0;        ///< Probability that a frame does not reach the log.
  double silence_period_s = 0.0;  ///< Period of times without any scan of any radar; 0: never.
  double silence_s = 0.0;         ///< Their duration.
  double blind_period_s = 0.0;    ///< Period of times when no radar sees anything; 0: never.
  double blind_s = 0.0;           ///< Their duration.
};

/// One drive, selected by name.
struct Scenario {
  std::string_view name;
  std::string_view description;
  double duration_s = 60.0;  ///< Unless another duration is given.
  CoursePlan course;
  WorldOptions world{};
  TrafficOptions traffic{};
  FaultOptions faults{};
};

const std::vector<Scenario>& scenarios();

/// nullptr if the name is unknown.
const Scenario* find_scenario(std::string_view name);

}  // namespace cremed
