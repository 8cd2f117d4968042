// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

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

}  // namespace cremed
