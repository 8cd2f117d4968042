// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulate/scene.hpp"

#include <cmath>

#include "cremed/estimator/cost/driving_share.hpp"
#include "tools/simulate/random.hpp"

namespace cremed {
namespace {

/// The course continues after the end, for the leading car.
constexpr double kMarginS = 5.0;

constexpr std::uint64_t kWorldStream = 1;
constexpr std::uint64_t kTrafficStream = 2;
constexpr std::uint64_t kBodyStream = 4;
constexpr std::uint64_t kBodySideStream = 5;
constexpr std::uint64_t kToldSpeedStream = 6;
constexpr std::uint64_t kToldYawRateStream = 7;

}  // namespace

Scene::Scene(const Scenario& scenario, double duration_s, std::int64_t start_us, std::uint64_t seed,
             double body_velocity_std_mps)
    : start_us_(start_us),
      end_us_(start_us + std::llround(duration_s * 1e6)),
      course_(scenario.course, duration_s + kMarginS),
      road_(course_),
      world_(road_, scenario.world, Random(seed, kWorldStream)),
      traffic_(course_, road_, scenario.traffic, Random(seed, kTrafficStream)),
      body_speed_(body_velocity_std_mps, Random(seed, kBodyStream)),
      body_side_speed_(body_velocity_std_mps, Random(seed, kBodySideStream)),
      vehicle_bus_(course_, Random(seed, kToldSpeedStream), Random(seed, kToldYawRateStream)) {}

VehicleState Scene::body(double time_s) const {
  VehicleState state = course_.at(time_s);
  state.speed_mps += driving_share(state.speed_mps) * body_speed_.at(time_s);
  state.side_speed_mps += driving_share(state.side_speed_mps) * body_side_speed_.at(time_s);
  return state;
}

}  // namespace cremed
