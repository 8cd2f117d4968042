// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/fusion/measurement/doppler_measurement.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"

namespace cremed {
namespace {

using namespace state_layout;

constexpr double kPeriodS = 0.075;

/// Speed of a vehicle in town: accelerates, drives, brakes and stands, 10 s each.
double town_speed_mps(double time_s) {
  const double in_cycle_s = std::fmod(time_s, 40.0);
  if (in_cycle_s < 10.0) {
    return 1.4 * in_cycle_s;
  }
  return in_cycle_s < 20.0 ? 14.0 : std::max(0.0, 14.0 - 1.4 * (in_cycle_s - 20.0));
}

/// Largest relative error of the speed at 14 m/s in the last minute of a drive straight ahead, with
/// true Doppler.
double speed_error_after(double minutes, const std::vector<Pose2>& mounts) {
  OdometryState state(OdometryOptions(), mounts);
  state.start();
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  double error = 0.0;
  for (std::int64_t i = 1; static_cast<double>(i) * kPeriodS < 60.0 * minutes; ++i) {
    const double time_s = static_cast<double>(i) * kPeriodS;
    state.advance_to(std::llround(time_s * 1e6));
    for (std::size_t radar = 0; radar < mounts.size(); ++radar) {
      state.advance_errors(radar, kPeriodS);
      DopplerVelocity velocity;
      velocity.covariance << 4e-4, 0.0, 0.0, 25e-4;
      velocity.per_offset = {mounts[radar].x_m > 0.0 ? -1.1 : 1.1, 0.0};
      velocity.velocity_mps = {town_speed_mps(time_s) + 0.02 * normal(random),
                               0.05 * normal(random)};
      state.gaussian.innovate(DopplerMeasurement{state, radar, 0.0}.linearise(velocity));
      state.update();
    }
    if (time_s > 60.0 * (minutes - 1.0) && town_speed_mps(time_s) == 14.0) {
      error = std::max(error, std::abs(state.gaussian.mean(kSpeed) / 14.0 - 1.0));
    }
  }
  return error;
}

TEST_CASE("an hour of accelerating and braking does not change the scale of speed") {
  const std::vector<Pose2> one{{3.4, 0.0, 0.0}};
  const std::vector<Pose2> two{{3.4, 0.0, 0.0}, {-0.6, 0.6, 3.1}};
  const std::vector<Pose2> three{{3.4, 0.0, 0.0}, {-0.6, 0.6, 3.1}, {-0.6, -0.6, -3.1}};
  const auto& mounts = GENERATE_REF(one, two, three);
  const double at_start = speed_error_after(2.0, mounts);
  const double after_an_hour = speed_error_after(60.0, mounts);
  CAPTURE(mounts.size(), at_start, after_an_hour);
  CHECK(at_start < 0.006);
  CHECK(after_an_hour < 0.006);  // The scale's prior has a sigma of 0.0028.
}

}  // namespace
}  // namespace cremed
