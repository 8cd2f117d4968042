// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/radar_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "cremed/estimator/scan/stamps.hpp"
#include "tools/eval/plane_motion.hpp"

namespace cremed {
namespace {

constexpr double kMaxTimeDifferenceS = 0.05;

SweepTarget seen_from_vehicle(const Target& target, const Pose2& mount) {
  const Eigen::Matrix2d turn = rotation_matrix(mount.yaw_rad);
  const Eigen::Vector2d sight = turn * Eigen::Vector2d(target.cos_bearing, target.sin_bearing);
  SweepTarget result;
  result.position_m = Eigen::Vector2d(mount.x_m, mount.y_m) + turn * position(target);
  result.covariance_m2 = turn * covariance_matrix(target) * turn.transpose();
  result.doppler_by_twist << -sight.x(), -sight.y(), sight.x() * mount.y_m - sight.y() * mount.x_m;
  result.doppler_mps = target.doppler_mps;
  return result;
}

const RecordedScan* nearest(const std::vector<RecordedScan>& scans, std::int64_t stamp_us) {
  const auto distance_s = [&](const RecordedScan& scan) {
    return std::abs(seconds_between(scan.stamp_us, stamp_us));
  };
  const auto best = std::ranges::min_element(scans, {}, distance_s);
  return best != scans.end() && distance_s(*best) <= kMaxTimeDifferenceS ? &*best : nullptr;
}

}  // namespace

std::vector<Sweep> sweeps(const Configuration& configuration,
                          const std::vector<RecordedRadar>& radars) {
  std::vector<Sweep> result;
  for (const RecordedScan& first : radars.front().scans) {
    Sweep sweep{first.stamp_us, {}};
    for (std::size_t i = 0; i < radars.size(); ++i) {
      const RecordedScan* scan = nearest(radars[i].scans, first.stamp_us);
      const Pose2& mount = configuration.radars[i].ego_motion.vehicle_from_radar;
      for (std::size_t k = 0; scan != nullptr && k < scan->targets.size(); ++k) {
        sweep.targets.push_back(seen_from_vehicle(scan->targets[k], mount));
        sweep.targets.back().age_s = seconds_between(scan->stamp_us, first.stamp_us);
      }
    }
    result.push_back(std::move(sweep));
  }
  return result;
}

}  // namespace cremed
