// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>
#include <vector>

#include "tools/simulate/traffic.hpp"
#include "tools/simulate/vehicle_course.hpp"
#include "tools/simulate/world.hpp"

namespace cremed {

/// What goes wrong on purpose.
struct FaultOptions {
  double frame_loss = 0.0;        ///< Probability that a frame does not reach the log.
  double silence_period_s = 0.0;  ///< Every so often all radars send no scan; 0: never.
  double silence_s = 0.0;         ///< For so long.
  double blind_period_s = 0.0;    ///< Every so often all radars see nothing; 0: never.
  double blind_s = 0.0;           ///< For so long.
};

/// One drive that can be asked for by name.
struct Scenario {
  std::string_view name;
  std::string_view description;
  double duration_s = 60.0;  ///< Unless another one is asked for.
  CoursePlan course;
  WorldOptions world;
  TrafficOptions traffic;
  FaultOptions faults;
};

const std::vector<Scenario>& scenarios();

/// nullptr if there is none of that name.
const Scenario* find_scenario(std::string_view name);

}  // namespace cremed
