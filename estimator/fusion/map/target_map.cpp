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
}

int TargetMap::scans() const {
  return static_cast<int>(
      std::count_if(scans_.begin(), scans_.end(), [](const Scan& scan) { return scan.size > 0; }));
}

void TargetMap::insert(std::size_t node, const TargetSet& targets, const Pose2& mount,
                       const Eigen::Vector3d& node_from_scan) {
  const Rotation turn(node_from_scan.z());
  const auto in_node = [&](double x_m, double y_m) -> Eigen::Vector2d {
    return turn * Eigen::Vector2d(x_m, y_m) + node_from_scan.head<2>();
  };
  Scan& scan = scans_[node];
  scan.size = targets.size();
  scan.radar_m = in_node(mount.x_m, mount.y_m);
  std::transform(targets.begin(), targets.end(), scan.targets.begin(), [&](const Target& target) {
    const Eigen::Vector2f at = in_node(target.x_m, target.y_m).cast<float>();
    const Symmetric2 c = turn * target.covariance_m2;
    return MapTarget{at.x(),
                     at.y(),
                     static_cast<float>(c.xx),
                     static_cast<float>(c.xy),
                     static_cast<float>(c.yy),
                     static_cast<float>(azimuth_rad(target, mount))};
  });
}

void TargetMap::place(const NodePoses& now_from_node) {
  first_in_.fill(-1);
  int size = 0;
  for (std::size_t node = 0; node < kNodes; ++node) {
    const Scan& scan = scans_[node];
    const Rotation turn(now_from_node[node].z());
    const Eigen::Vector2d place = now_from_node[node].head<2>();
    radar_m_[node] = turn * scan.radar_m + place;
    for (std::size_t i = 0; i < scan.size; ++i, ++size) {
      const MapTarget& target = scan.targets[i];
      const Eigen::Vector2d at =
          turn * Eigen::Vector2d(static_cast<double>(target.x_m), static_cast<double>(target.y_m)) +
          place;
      int& first = first_in_[slot_of(cell_of(at.x()), cell_of(at.y()))];
      const Symmetric2 covariance{static_cast<double>(target.xx_m2),
                                  static_cast<double>(target.xy_m2),
                                  static_cast<double>(target.yy_m2)};
      placed_[static_cast<std::size_t>(size)] = {at, turn * covariance,
                                                 static_cast<double>(target.azimuth_rad),
                                                 static_cast<std::uint8_t>(node), first};
      first = size;
    }
  }
}

int TargetMap::cell_of(double m) { return static_cast<int>(std::floor(m / kCellM)); }

}  // namespace cremed
