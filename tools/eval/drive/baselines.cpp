// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/baselines.hpp"

#include <array>
#include <cstddef>
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

struct Submap {
  const char* name;
  SubmapOptions options;
};

/// The paper's map, and one of 6 s: more sweeps fill smaller cells.
constexpr std::array kSubmaps{Submap{"submap", {10, 3.0}}, Submap{"submap_80", {80, 1.5}}};

std::vector<SubmapOdometry> empty_submaps() {
  std::vector<SubmapOdometry> result;
  result.reserve(kSubmaps.size());
  for (const Submap& submap : kSubmaps) {
    result.emplace_back(submap.options);
  }
  return result;
}

}  // namespace

std::vector<RecordedOdometry> baselines(const Configuration& configuration,
                                        const std::vector<RecordedRadar>& radars) {
  std::vector<RecordedOdometry> result{{"kellner", {}, 0}};
  for (const Submap& submap : kSubmaps) {
    result.push_back({submap.name, {}, 0});
  }
  std::vector<SubmapOdometry> submaps = empty_submaps();
  std::optional<KellnerVelocity> before;
  std::int64_t before_us = 0;
  for (const Sweep& sweep : sweeps(configuration, radars)) {
    const auto velocity = kellner_velocity(sweep.targets);
    if (before && velocity) {
      const double dt_s = seconds_between(before_us, sweep.stamp_us);
      const auto expected = by_velocity(*before, *velocity, dt_s);
      result[0].estimates.push_back(
          {before_us, sweep.stamp_us, expected.motion, expected.covariance});
      for (std::size_t i = 0; i < submaps.size(); ++i) {
        const auto match = submaps[i].update(sweep, *velocity, expected.motion, dt_s);
        result[1 + i].estimates.push_back(
            {before_us, sweep.stamp_us, match.motion, match.covariance});
      }
    } else {
      submaps = empty_submaps();
      for (RecordedOdometry& method : result) {
        ++method.without_estimate;
      }
    }
    before = velocity;
    before_us = sweep.stamp_us;
  }
  return result;
}

}  // namespace cremed
