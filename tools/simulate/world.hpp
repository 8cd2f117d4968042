// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "tools/simulate/random.hpp"
#include "tools/simulate/road.hpp"

namespace cremed {

/// Finds points near a place without visiting all. The order of the results depends on the order of
/// insertion only.
class SpatialGrid {
 public:
  explicit SpatialGrid(double cell_m) : cell_m_(cell_m) {}

  void insert(double x_m, double y_m, std::size_t index) {
    cells_[key(cell(x_m), cell(y_m))].push_back(index);
  }

  /// Calls `visit(index)` for all points in the cells that the square of half width `radius_m`
  /// touches; the caller checks the distance.
  template <typename Visit>
  void visit_near(double x_m, double y_m, double radius_m, Visit&& visit) const {
    for (std::int32_t i = cell(x_m - radius_m); i <= cell(x_m + radius_m); ++i) {
      for (std::int32_t j = cell(y_m - radius_m); j <= cell(y_m + radius_m); ++j) {
        const auto found = cells_.find(key(i, j));
        if (found == cells_.end()) continue;
        for (const std::size_t index : found->second) visit(index);
      }
    }
  }

 private:
  [[nodiscard]] std::int32_t cell(double coordinate_m) const {
    return static_cast<std::int32_t>(std::floor(coordinate_m / cell_m_));
  }
  static std::uint64_t key(std::int32_t i, std::int32_t j) {
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) << 32U) |
           static_cast<std::uint32_t>(j);
  }

  double cell_m_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells_;
};

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
