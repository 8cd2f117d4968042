// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "cremed/can_decoders/radar_scan.hpp"
#include "cremed/estimator/fusion/state/state_layout.hpp"
#include "cremed/estimator/scan/pose2.hpp"
#include "cremed/estimator/scan/symmetric2.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// The static targets of one radar's scans of the last seconds. Each scan belongs to a node, a
/// clone of the vehicle's pose in the filter's state, and moves with the estimate of that pose. The
/// capacity is fixed; a spatial hash finds the targets near a point.
class TargetMap {
 public:
  static constexpr std::size_t kNodes = state_layout::kNodes;
  /// Edge of a cell of the spatial hash, and the greatest distance at which targets may be the
  /// same: 2 sigma of an ARS408's azimuth at 75 m.
  static constexpr double kCellM = 2.5;

  using NodePoses = std::array<Eigen::Vector3d, kNodes>;

  /// A target in the frame of the present pose.
  struct Placed {
    Eigen::Vector2d at_m;
    Symmetric2 covariance_m2;
    double azimuth_rad;  ///< In the radar's frame when it was measured.
    std::uint8_t node;
    int next;  ///< In its cell; -1: none.
  };

  void clear();
  void drop(std::size_t node) { scans_[node].size = 0; }
  /// Adds a scan to a node. `node_from_scan`: pose of the vehicle at the scan in the node's frame.
  void insert(std::size_t node, const TargetSet& targets, const Pose2& mount,
              const Eigen::Vector3d& node_from_scan);
  [[nodiscard]] bool has(std::size_t node) const { return scans_[node].size > 0; }
  [[nodiscard]] int scans() const;

  /// Places all targets. `now_from_node`: poses of the nodes in the frame of the present pose.
  void place(const NodePoses& now_from_node);
  /// Place of the radar at a node's scan, in the frame of the present pose.
  [[nodiscard]] const Eigen::Vector2d& radar_m(std::size_t node) const { return radar_m_[node]; }
  /// Calls `visit(const Placed&)` for every target in the cell of a point and in the eight around.
  template <typename Visit>
  void for_each_near(double x_m, double y_m, Visit visit) const {
    const int column = cell_of(x_m);
    const int row = cell_of(y_m);
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        int i = first_in_[slot_of(column + dx, row + dy)];
        while (i >= 0) {
          const Placed& target = placed_[static_cast<std::size_t>(i)];
          visit(target);
          i = target.next;
        }
      }
    }
  }

 private:
  /// Targets of cells that are a multiple of 160 m apart share a slot, and are then visited in
  /// vain.
  static constexpr std::size_t kSlotsPerAxis = 64;

  struct MapTarget {
    float x_m;
    float y_m;
    float xx_m2;
    float xy_m2;
    float yy_m2;
    float azimuth_rad;
  };
  struct Scan {
    std::size_t size = 0;
    Eigen::Vector2d radar_m;  // In the node's frame.
    std::array<MapTarget, kMaxDetections> targets;
  };

  static int cell_of(double m);
  static std::size_t slot_of(int column, int row) {
    return (static_cast<std::size_t>(column) % kSlotsPerAxis) * kSlotsPerAxis +
           static_cast<std::size_t>(row) % kSlotsPerAxis;
  }

  std::array<Scan, kNodes> scans_;
  std::array<Eigen::Vector2d, kNodes> radar_m_;
  std::array<Placed, kNodes * kMaxDetections> placed_;
  std::array<int, kSlotsPerAxis * kSlotsPerAxis> first_in_;
};

}  // namespace cremed
