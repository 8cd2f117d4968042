// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/map/target_map.hpp"

#include <algorithm>
#include <cmath>

#include "cremed/estimator/scan/rotation.hpp"

namespace cremed {

void TargetMap::clear() {
  for (Scan& scan : scans_) {
    scan.size = 0;
  }
  size_ = 0;
}

int TargetMap::scans() const {
  return static_cast<int>(
      std::count_if(scans_.begin(), scans_.end(), [](const Scan& scan) { return scan.size > 0; }));
}

void TargetMap::insert(std::size_t node, const TargetSet& targets,
                       const Eigen::Vector3d& node_from_scan) {
  Scan& scan = scans_[node];
  const Rotation turn(node_from_scan.z());
  scan.size = targets.size();
  std::transform(targets.begin(), targets.end(), scan.targets.begin(), [&](const Target& target) {
    const Eigen::Vector2d at =
        turn * Eigen::Vector2d(target.x_m, target.y_m) + node_from_scan.head<2>();
    const Symmetric2 c = turn * target.covariance_m2;
    return MapTarget{static_cast<float>(at.x()), static_cast<float>(at.y()),
                     static_cast<float>(c.xx), static_cast<float>(c.xy), static_cast<float>(c.yy)};
  });
}

void TargetMap::place(std::span<const Eigen::Vector3d, kNodes> now_from_node) {
  heads_.fill(-1);
  size_ = 0;
  for (std::size_t node = 0; node < kNodes; ++node) {
    const Scan& scan = scans_[node];
    const Rotation turn(now_from_node[node].z());
    way_m_[node] = now_from_node[node].head<2>().norm();
    for (std::size_t i = 0; i < scan.size; ++i) {
      const MapTarget& target = scan.targets[i];
      const Eigen::Vector2d at =
          turn * Eigen::Vector2d(target.x_m, target.y_m) + now_from_node[node].head<2>();
      placed_[size_] = {at.x(), at.y(), turn * Symmetric2{target.xx_m2, target.xy_m2, target.yy_m2},
                        static_cast<std::uint8_t>(node)};
      int& head = heads_[slot_of(cell_of(at.x()), cell_of(at.y()))];
      next_[size_] = head;
      head = static_cast<int>(size_);
      ++size_;
    }
  }
}

int TargetMap::cell_of(double m) { return static_cast<int>(std::floor(m / kCellM)); }

std::size_t TargetMap::slot_of(int column, int row) {
  // Neighbouring cells of a map of up to 160 m by 160 m do not collide.
  const auto wrapped = [](int cell) { return static_cast<std::size_t>(cell) & 63U; };
  return wrapped(column) * 64U + wrapped(row);
}

}  // namespace cremed
