// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "tools/simulate/random.hpp"
#include "tools/simulate/road.hpp"
#include "tools/simulate/spatial_grid.hpp"

namespace cremed {

/// A point reflector.
struct Reflector {
  double x_m = 0.0;
  double y_m = 0.0;
  double rcs_dbm2 = 0.0;               ///< Mean; it fluctuates from scan to scan.
  double detection_probability = 0.0;  ///< In one scan, close to the radar.
};

enum class Roadside : std::uint8_t {
  street,  ///< Walls of houses, guard rails, parked cars, trees.
  tunnel,  ///< Smooth walls on both sides without fixed reflectors.
  garage,  ///< Pillars, parked cars and walls, close on both sides.
};

struct WorldOptions {
  double built_share = 0.8;    ///< Share of a street's sides with structures.
  double clutter_per_m = 1.2;  ///< Single reflectors per metre of the road.
  Roadside roadside = Roadside::street;
  /// Single reflectors per square metre of the box around the road, for roads that wind in a small
  /// area.
  double clutter_per_m2 = 0.0;
};

/// All static objects: walls, guard rails, parked cars and trees along the road, and clutter around
/// it. The road itself is free, also where it crosses itself.
class World {
 public:
  World(const Road& road, const WorldOptions& options, Random random);

  [[nodiscard]] const std::vector<Reflector>& reflectors() const { return reflectors_; }
  [[nodiscard]] const SpatialGrid& grid() const { return grid_; }

 private:
  std::vector<Reflector> reflectors_;
  SpatialGrid grid_;
};

}  // namespace cremed
