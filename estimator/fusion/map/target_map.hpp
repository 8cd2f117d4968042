// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "cremed/can_decoders/radar_scan.hpp"
#include "cremed/estimator/fusion/state/state_layout.hpp"
#include "cremed/estimator/scan/symmetric2.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Static targets of one radar's scans of the last seconds. Each scan hangs on one of the cloned
/// poses of the filter's state (a "node"), so that targets move with the estimate of that pose.
/// Capacity is fixed; nothing allocates after construction.
class TargetMap {
 public:
  static constexpr std::size_t kNodes = state_layout::kNodes;
  static constexpr std::size_t kMaxTargets = kNodes * kMaxDetections;
  /// Greatest distance of a candidate partner, per axis between one and two of it are searched.
  static constexpr double kCellM = 2.5;

  /// A target in the frame of the present pose.
  struct Placed {
    double x_m;
    double y_m;
    Symmetric2 covariance_m2;
    std::uint8_t node;
  };

  void clear();
  void drop(std::size_t node) { scans_[node].size = 0; }
  /// Hangs a scan on a node. `node_from_scan`: the vehicle's pose at the scan in the node's frame.
  void insert(std::size_t node, const TargetSet& targets, const Eigen::Vector3d& node_from_scan);
  [[nodiscard]] bool has(std::size_t node) const { return scans_[node].size > 0; }
  [[nodiscard]] int scans() const;

  /// Places all targets. `now_from_node`: pose of each node in the frame of the present pose.
  [[nodiscard]] double way_m(std::size_t node) const { return way_m_[node]; }
  void place(std::span<const Eigen::Vector3d, kNodes> now_from_node);
  [[nodiscard]] std::span<const Placed> placed() const { return {placed_.data(), size_}; }

  /// Calls `visit(index in placed())` for each target in the cells around a point.
  template <typename Visit>
  void for_each_near(double x_m, double y_m, Visit visit) const {
    const int column = cell_of(x_m);
    const int row = cell_of(y_m);
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int i = heads_[slot_of(column + dx, row + dy)]; i >= 0;
             i = next_[static_cast<std::size_t>(i)]) {
          if (cell_of(placed_[static_cast<std::size_t>(i)].x_m) == column + dx &&
              cell_of(placed_[static_cast<std::size_t>(i)].y_m) == row + dy) {
            visit(static_cast<std::size_t>(i));
          }
        }
      }
    }
  }

 private:
  /// Cells of the hash table: no more targets than cells, so that chains stay short.
  static constexpr std::size_t kSlots = 4096;

  struct MapTarget {
    float x_m;
    float y_m;
    float xx_m2;
    float xy_m2;
    float yy_m2;
  };
  struct Scan {
    std::size_t size = 0;
    std::array<MapTarget, kMaxDetections> targets;
  };

  static int cell_of(double m);
  static std::size_t slot_of(int column, int row);

  std::array<Scan, kNodes> scans_;
  std::array<Placed, kMaxTargets> placed_;
  std::array<int, kMaxTargets> next_;
  std::array<int, kSlots> heads_;
  std::size_t size_ = 0;
  std::array<double, kNodes> way_m_{};
};

}  // namespace cremed
