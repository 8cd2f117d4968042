// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/baselines.hpp"

#include <cmath>
#include <optional>

#include "cremed/estimator/scan/stamps.hpp"
#include "tools/eval/drive/kellner_velocity.hpp"
#include "tools/eval/drive/radar_sweep.hpp"
#include "tools/eval/drive/submap_odometry.hpp"
#include "tools/eval/plane_motion.hpp"

namespace cremed {
namespace {

SubmapOdometry::Result by_velocity(const KellnerVelocity& from, const KellnerVelocity& to,
                                   double dt_s) {
  Eigen::Vector3d motion = 0.5 * dt_s * (from.twist + to.twist);
  motion.head<2>() = rotation_matrix(0.5 * motion.z()) * motion.head<2>();
  return {motion, 0.25 * dt_s * dt_s * (from.covariance + to.covariance)};
}

}  // namespace

std::vector<RecordedOdometry> baselines(const Configuration& configuration,
                                        const std::vector<std::string>& logs) {
  std::vector<RecordedOdometry> result{{"kellner", {}, 0}, {"submap", {}, 0}};
  SubmapOdometry submap;
  std::optional<KellnerVelocity> before;
  std::int64_t before_us = 0;
  for (const Sweep& sweep : sweeps(configuration, record_drive(configuration, logs))) {
    const auto velocity = kellner_velocity(sweep.targets);
    if (before && velocity) {
      const double dt_s = seconds_between(before_us, sweep.stamp_us);
      const auto expected = by_velocity(*before, *velocity, dt_s);
      const auto match = submap.update(sweep, *velocity, expected.motion, dt_s);
      result[0].estimates.push_back(
          {before_us, sweep.stamp_us, expected.motion, expected.covariance});
      result[1].estimates.push_back({before_us, sweep.stamp_us, match.motion, match.covariance});
    } else {
      submap = {};
      ++result[0].without_estimate;
      ++result[1].without_estimate;
    }
    before = velocity;
    before_us = sweep.stamp_us;
  }
  return result;
}

}  // namespace cremed
