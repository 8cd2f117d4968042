// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "tools/eval/calibrate/matched_targets.hpp"
#include "tools/eval/calibrate/noise_factor.hpp"

namespace cremed {
namespace {

struct Noise {
  double factor;
  double other_std;
  double nonsense;
};

std::vector<ScaledError> draw_errors(const Noise& row, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-kErrorGate, kErrorGate);
  std::vector<ScaledError> errors;
  for (int i = 0; i < 4000; ++i) {
    const bool is_nonsense = 0.1 * (uniform(random) / kErrorGate + 1.0) * 5.0 < row.nonsense;
    const double error = std::hypot(row.factor, row.other_std) * normal(random);
    errors.push_back(
        {i * 10'000, is_nonsense ? uniform(random) : error, row.other_std * row.other_std});
  }
  return errors;
}

TEST_CASE("the noise factor is that of the errors, whatever nonsense is among them") {
  const auto row = GENERATE(Noise{1.0, 0.0, 0.0}, Noise{0.4, 0.0, 0.0}, Noise{0.7, 0.0, 0.2},
                            Noise{1.3, 0.0, 0.1}, Noise{1.0, 1.0, 0.1}, Noise{0.5, 0.5, 0.0});
  CAPTURE(row.factor, row.other_std, row.nonsense);
  double squares = 0.0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const StdFactor found = noise_factor(draw_errors(row, seed));
    CHECK(found.value == Approx(row.factor).epsilon(0.15));
    squares += std::pow((found.value - row.factor) / found.std, 2);
  }
  CHECK(squares / 10.0 < 3.0);
  CHECK(squares / 10.0 > 0.1);
}

TEST_CASE("too few errors, or none that are the sensor's, tell no factor") {
  CHECK(noise_factor({}).std == 0.0);
  CHECK(noise_factor(std::vector<ScaledError>(100, {0, 1.0, 0.0})).std == 0.0);
  CHECK(noise_factor(draw_errors({0.0, 0.8, 0.0}, 1)).value == 1.0);
}

Target placed_at(double x_m, double y_m) {
  Target target;
  target.x_m = x_m;
  target.y_m = y_m;
  target.bearing_rad = std::atan2(y_m, x_m);
  target.cos_bearing = std::cos(target.bearing_rad);
  target.sin_bearing = std::sin(target.bearing_rad);
  target.bearing_std_rad = 0.03;
  target.covariance_m2 = polar_covariance(std::hypot(x_m, y_m), target.bearing_rad, 0.3, 0.03);
  return target;
}

TEST_CASE("targets found again show their errors in both scans' standard deviations") {
  // The radar goes 1 m ahead and turns by 0.1 rad; the second target is 0.3 m too far.
  const Pose2 motion{1.0, 0.0, 0.1};
  const auto seen = [&](double x_m, double y_m, double more_m) {
    const double c = std::cos(motion.yaw_rad);
    const double s = std::sin(motion.yaw_rad);
    const double range_m = std::hypot(x_m - 1.0, y_m);
    const double scale = (range_m + more_m) / range_m;
    return placed_at(scale * (c * (x_m - 1.0) + s * y_m), scale * (c * y_m - s * (x_m - 1.0)));
  };
  const RecordedScan previous{0, {placed_at(20.0, 0.0), placed_at(30.0, 1.0)}};
  const RecordedScan current{70'000, {seen(20.0, 0.0, 0.0), seen(30.0, 1.0, 0.3)}};
  MatchErrors errors;
  add_match_errors(previous, current, motion, {}, errors);
  REQUIRE(errors.range.size() == 2);
  CHECK(errors.range[0].error == Approx(0.0).margin(1e-9));
  CHECK(errors.range[1].error == Approx(1.0 / std::sqrt(2.0)).margin(0.01));
  CHECK(errors.azimuth[0].error == Approx(0.0).margin(1e-9));
  CHECK(errors.azimuth[1].error == Approx(0.0).margin(0.02));
  CHECK(errors.range[1].stamp_us == 70'000);
}

TEST_CASE("a target with two candidates is no match") {
  const RecordedScan previous{0, {placed_at(20.0, 0.0), placed_at(20.5, 0.1)}};
  const RecordedScan current{70'000, {placed_at(20.2, 0.0)}};
  MatchErrors errors;
  add_match_errors(previous, current, {}, {}, errors);
  add_match_errors(current, previous, {}, {}, errors);
  CHECK(errors.range.empty());
}

}  // namespace
}  // namespace cremed
