// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <catch2/catch.hpp>

#include "cremed/estimator/scan/degrees.hpp"
#include "tools/laboratory/table/simulated_pairs.hpp"

using namespace cremed;

namespace {

bool is_same(const std::vector<Detection>& a, const std::vector<Detection>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Detection& x, const Detection& y) {
                      return x.id == y.id && x.range_m == y.range_m &&
                             x.azimuth_rad == y.azimuth_rad && x.doppler_mps == y.doppler_mps;
                    });
}

bool is_same(const RegistrationPair& a, const RegistrationPair& b) {
  return a.truth.x_m == b.truth.x_m && a.truth.yaw_rad == b.truth.yaw_rad &&
         is_same(a.previous, b.previous) && is_same(a.current, b.current);
}

struct Moments {
  double sum = 0.0;
  double squares = 0.0;
  double count = 0.0;

  void add(double value) {
    sum += value;
    squares += value * value;
    count += 1.0;
  }
  [[nodiscard]] double mean() const { return sum / count; }
  [[nodiscard]] double variance() const { return squares / count - mean() * mean(); }
};

/// Errors of the detections of one landmark are independent, so half of their squared difference in
/// two runs at the same pose has the noise's variance. The previous scan is always at the same
/// pose.
using ById = std::map<std::uint16_t, Detection>;

ById by_id(const std::vector<Detection>& scan) {
  ById result;
  for (const Detection& detection : scan) {
    result[detection.id] = detection;
  }
  return result;
}

}  // namespace

TEST_CASE("A pair depends on seed, set and run, and on nothing else") {
  for (const SimulatedProblem problem : kSimulatedProblems) {
    CAPTURE(settings(problem).name);
    const RegistrationPair pair = simulated_pair(problem, 7, 2, 3);
    CHECK(is_same(pair, simulated_pair(problem, 7, 2, 3)));
    CHECK_FALSE(is_same(pair, simulated_pair(problem, 8, 2, 3)));
    CHECK_FALSE(is_same(pair, simulated_pair(problem, 7, 1, 3)));
    CHECK_FALSE(is_same(pair, simulated_pair(problem, 7, 2, 4)));
    const auto pairs = simulated_pairs(problem, 7, 3, 5);
    REQUIRE(pairs.size() == 15);
    CHECK(is_same(pairs[2 * 5 + 3], pair));
  }
}

TEST_CASE("Range and azimuth scatter about the landmark with the standard deviation they state") {
  const auto problem = GENERATE(SimulatedProblem::psr, SimulatedProblem::sim_c);
  CAPTURE(settings(problem).name);
  Moments range;
  Moments azimuth;
  for (std::size_t set = 0; set < 40; ++set) {
    for (std::size_t run = 0; run < 20; run += 2) {
      const ById first = by_id(simulated_pair(problem, 1, set, run).previous);
      const ById second = by_id(simulated_pair(problem, 1, set, run + 1).previous);
      REQUIRE(first.size() == second.size());
      for (const auto& [id, a] : first) {
        const Detection& b = second.at(id);
        range.add((a.range_m - b.range_m) / (std::sqrt(2.0) * a.range_std_m));
        azimuth.add((a.azimuth_rad - b.azimuth_rad) / (std::sqrt(2.0) * a.azimuth_std_rad));
      }
    }
  }
  // Four standard deviations of mean and variance of at least 8000 normal numbers.
  REQUIRE(range.count >= 8000);
  CHECK(range.mean() == Approx(0.0).margin(0.045));
  CHECK(range.variance() == Approx(1.0).margin(0.064));
  CHECK(azimuth.mean() == Approx(0.0).margin(0.045));
  CHECK(azimuth.variance() == Approx(1.0).margin(0.064));
}

TEST_CASE("Both scans see the same landmarks, the current one from the true pose") {
  Moments radial;
  Moments across;
  for (const RegistrationPair& pair : simulated_pairs(SimulatedProblem::psr, 3, 30, 10)) {
    const ById previous = by_id(pair.previous);
    for (const Detection& b : pair.current) {
      const Detection& a = previous.at(b.id);
      const double yaw_rad = b.azimuth_rad + pair.truth.yaw_rad;
      const double x_m = pair.truth.x_m + b.range_m * std::cos(yaw_rad);
      const double y_m = pair.truth.y_m + b.range_m * std::sin(yaw_rad);
      const double turn_rad =
          std::remainder(std::atan2(y_m, x_m) - a.azimuth_rad, 2.0 * std::numbers::pi);
      radial.add((std::hypot(x_m, y_m) - a.range_m) / (std::sqrt(2.0) * a.range_std_m));
      across.add(turn_rad / (std::sqrt(2.0) * a.azimuth_std_rad));
    }
  }
  REQUIRE(radial.count == 6000);
  CHECK(radial.mean() == Approx(0.0).margin(0.052));
  CHECK(radial.variance() == Approx(1.0).margin(0.08));
  CHECK(across.mean() == Approx(0.0).margin(0.052));
  CHECK(across.variance() == Approx(1.0).margin(0.08));
}

TEST_CASE("Doppler is the range rate of the current scan's landmarks") {
  Moments error;
  for (const RegistrationPair& pair : simulated_pairs(SimulatedProblem::sim, 3, 50, 10)) {
    for (const Detection& detection : pair.current) {
      const double expected_mps = -pair.truth.x_m / pair.dt_s * std::cos(detection.azimuth_rad);
      error.add((detection.doppler_mps - expected_mps) / detection.doppler_std_mps);
    }
  }
  REQUIRE(error.count > 5000);
  CHECK(error.mean() == Approx(0.0).margin(0.056));
  CHECK(error.variance() == Approx(1.0).margin(0.08));
}

TEST_CASE("Motion is uniform over the paper's range") {
  const auto [problem, dof] = GENERATE(
      table<SimulatedProblem, int>({{SimulatedProblem::psr, 3}, {SimulatedProblem::sim, 2}}));
  Moments x;
  Moments y;
  Moments yaw;
  for (const RegistrationPair& pair : simulated_pairs(problem, 2, 10, 300)) {
    CHECK(std::abs(pair.truth.x_m) <= 0.25);
    CHECK(std::abs(pair.truth.yaw_rad) <= 15.0 * kRadPerDeg);
    x.add(pair.truth.x_m / 0.25);
    y.add(pair.truth.y_m / 0.25);
    yaw.add(pair.truth.yaw_rad / (15.0 * kRadPerDeg));
  }
  CHECK(x.variance() == Approx(1.0 / 3.0).margin(0.03));
  CHECK(yaw.variance() == Approx(1.0 / 3.0).margin(0.03));
  CHECK(y.variance() == Approx(dof == 3 ? 1.0 / 3.0 : 0.0).margin(0.03));
}

TEST_CASE("As many targets are seen as the problem says, within the field of view") {
  struct Row {
    SimulatedProblem problem;
    std::size_t landmarks;
    double visible;  // expected share
  };
  // 80 of 110 degrees; the current scan has turned by up to 15 degrees, which loses none on
  // average.
  const auto row = GENERATE(
      Row{SimulatedProblem::psr, 20, 1.0}, Row{SimulatedProblem::psr_c, 36, 1.0},
      Row{SimulatedProblem::sim, 20, 80.0 / 110.0}, Row{SimulatedProblem::sim_c, 36, 80.0 / 110.0});
  CAPTURE(settings(row.problem).name);
  std::size_t previous = 0;
  std::size_t current = 0;
  const auto pairs = simulated_pairs(row.problem, 4, 400, 2);
  for (const RegistrationPair& pair : pairs) {
    previous += pair.previous.size();
    current += pair.current.size();
    for (const Detection& detection : pair.current) {
      CHECK(detection.id < row.landmarks);
      if (row.visible < 1.0) {
        CHECK(std::abs(detection.azimuth_rad) <
              40.0 * kRadPerDeg + 6.0 * detection.azimuth_std_rad);
      }
    }
  }
  const double possible = static_cast<double>(pairs.size() * row.landmarks);
  CHECK(static_cast<double>(previous) / possible == Approx(row.visible).margin(0.025));
  CHECK(static_cast<double>(current) / possible == Approx(row.visible).margin(0.025));
}

TEST_CASE("In a clustered problem eight landmarks have two others close by") {
  const RegistrationPair pair = simulated_pair(SimulatedProblem::psr_c, 1, 0, 0);
  const ById targets = by_id(pair.previous);
  for (std::uint16_t i = 0; i < 8; ++i) {
    for (int extra = 0; extra < 2; ++extra) {
      const Detection& a = targets.at(i);
      const Detection& b = targets.at(static_cast<std::uint16_t>(20 + 2 * i + extra));
      // 5 sigma: 0.1 m of the cluster, 0.2 m of each range.
      CHECK(std::abs(a.range_m - b.range_m) < 5.0 * 0.3);
    }
  }
}
