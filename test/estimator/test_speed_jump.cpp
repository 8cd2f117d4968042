// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/doubt/radar/speed_jump.hpp"

namespace cremed {
namespace {

constexpr double kCycleS = 0.075;
constexpr double kNoiseMps = 0.03;
using SpeedAt = std::function<double(double time_s)>;

/// The jumps of a speed in 10 s, of which every `lost`th scan is missing, and whose stamps
/// wait for the end of a halt of the computer every 1.6 s.
std::vector<SpeedJump::Jump> jumps_of(const SpeedAt& speed_at, int lost = 1000,
                                      double halt_s = 0.0) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0.0, kNoiseMps);
  SpeedJump check;
  std::vector<SpeedJump::Jump> result;
  for (int i = 1; i < 134; ++i) {
    DopplerVelocity velocity;
    velocity.velocity_mps = {speed_at(i * kCycleS) + normal(random), normal(random)};
    velocity.covariance.diagonal().setConstant(kNoiseMps * kNoiseMps);
    const double since_halt_s = std::fmod(i * kCycleS, 1.6);
    const double late_s = std::max(0.0, halt_s - since_halt_s);
    const auto jump = i % lost == 0
                          ? std::nullopt
                          : check.add(std::llround((i * kCycleS + late_s) * 1e6), velocity);
    if (jump) result.push_back(*jump);
  }
  return result;
}

/// From `from_s` on the acceleration grows to `mps2` with that jerk, and lasts.
SpeedAt braking_speed(double from_s, double mps2, double jerk_mps3) {
  return [=](double time_s) {
    const double since_s = std::max(0.0, time_s - from_s);
    const double growing_s = mps2 / jerk_mps3;
    const double grown_s = std::min(since_s, growing_s);
    return std::max(0.0, 20.0 - 0.5 * jerk_mps3 * grown_s * grown_s -
                             mps2 * std::max(0.0, since_s - growing_s));
  };
}

TEST_CASE("A speed that jumps is found with the next scan, there and back") {
  const double by_mps = GENERATE(-8.0, -1.2, 1.2, 8.0);
  CAPTURE(by_mps);
  const auto found =
      jumps_of([&](double time_s) { return 8.0 + (time_s > 4.0 && time_s < 7.0 ? by_mps : 0.0); });
  REQUIRE(found.size() == 2);
  CHECK(1e-6 * static_cast<double>(found[0].stamp_us) == Approx(4.0).margin(kCycleS));
  CHECK(1e-6 * static_cast<double>(found[1].stamp_us) == Approx(7.0).margin(kCycleS));
  for (const SpeedJump::Jump& jump : found) {
    const bool is_first = &jump == &found[0];
    CHECK(jump.before_mps == Approx(is_first ? 8.0 : 8.0 + by_mps).margin(5.0 * kNoiseMps));
    CHECK(jump.after_mps == Approx(is_first ? 8.0 + by_mps : 8.0).margin(5.0 * kNoiseMps));
  }
}

TEST_CASE("No vehicle jumps: emergency braking, a stop, lost scans") {
  const double from_s = 2.0 + GENERATE(0.0, 0.02, 0.04, 0.06);
  const int lost = GENERATE(3, 5, 1000);
  CAPTURE(from_s, lost);
  CHECK(jumps_of(braking_speed(from_s, 9.0, 90.0), lost).empty());
  CHECK(jumps_of(braking_speed(from_s, 4.0, 20.0), lost).empty());
  CHECK(jumps_of([](double time_s) { return 10.0 + 3.0 * std::sin(time_s); }, lost).empty());
}

TEST_CASE("Stamps that are late while braking are no jump") {
  const double from_s = 2.0 + GENERATE(0.0, 0.02, 0.04, 0.06);
  const double halt_s = GENERATE(0.05, 0.06, 0.07);
  CAPTURE(from_s, halt_s);
  CHECK(jumps_of(braking_speed(from_s, 5.0, 25.0), 1000, halt_s).empty());
}

TEST_CASE("One scan that is wrong is no jump") {
  CHECK(jumps_of([](double time_s) { return std::abs(time_s - 4.0) < 0.03 ? 3.0 : 8.0; }).empty());
}

}  // namespace
}  // namespace cremed
