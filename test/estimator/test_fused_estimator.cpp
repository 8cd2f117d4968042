// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "estimator/fused_estimator.hpp"
#include "test/estimator/drawn_vehicle.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using simulation::Course;
using simulation::drawn_options;
using simulation::drawn_radars;
using simulation::DrawnMotion;
using simulation::DrawnRadar;
using simulation::DrawnVehicle;

constexpr std::uint64_t kSeeds = 30;

/// Errors over the time that they took.
struct Errors {
  void add(const Eigen::Vector3d& error, const EgoMotion& motion) {
    const double dt_s = static_cast<double>(motion.utime_us - motion.utime_start_us) * 1e-6;
    squares += (error / dt_s).cwiseAbs2();
    nees += error.dot(motion.covariance.llt().solve(error)) / 3.0;
    axes += error.cwiseAbs2().cwiseQuotient(motion.covariance.diagonal());
    ++count;
  }
  [[nodiscard]] Eigen::Vector3d rms() const { return (squares / count).cwiseSqrt(); }
  [[nodiscard]] double anees() const { return nees / count; }

  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  Eigen::Vector3d axes = Eigen::Vector3d::Zero();
  double nees = 0.0;
  double count = 0.0;
};

struct Regime {
  const char* name;
  int degrees_of_freedom;
  Course course;
  double min_anees = 0.8;
};

Eigen::Vector3d standing(double /*time_s*/) { return Eigen::Vector3d::Zero(); }
/// At 4 m/s^2, rolls on, and takes up speed again at half of that.
Eigen::Vector3d braking(double time_s) {
  const double phase_s = std::fmod(time_s, 10.0);
  return {15.0 - 4.0 * std::min(phase_s, 2.0) + 2.0 * std::max(phase_s - 6.0, 0.0), 0.0, 0.1};
}
Eigen::Vector3d reversing(double time_s) { return {-3.0, 0.0, 0.2 * std::sin(time_s)}; }
Eigen::Vector3d skidding(double time_s) {
  return {10.0, 1.5 * std::sin(0.8 * time_s), 0.2 * std::sin(0.5 * time_s)};
}

/// The errors of all fused motions, and of each radar by itself.
struct Outcome {
  Errors fused;
  std::vector<Errors> single;
  int gaps = 0;
};

void drive(const Regime& regime, std::size_t radars, std::uint64_t seed, Outcome& outcome) {
  const EgoMotionOptions options = drawn_options(regime.degrees_of_freedom);
  simulation::Random random(1000 + seed);
  const double slip_rad =
      regime.degrees_of_freedom == 2
          ? FusedOptions{}.side_slip_std_rad * std::normal_distribution<double>()(random)
          : 0.0;
  const Course course = [&](double time_s) {
    Eigen::Vector3d velocity = regime.course(time_s);
    velocity.y() += slip_rad * velocity.x();
    return velocity;
  };
  DrawnVehicle vehicle(course, drawn_radars(radars), options, seed);
  FusedEstimator estimator({}, options, radars);
  std::int64_t reached_us = 0;
  while (vehicle.time_s() < 20.0) {
    const DrawnMotion drawn = vehicle.next();
    if (drawn.motion.has_estimate()) {
      outcome.single[drawn.radar].add(drawn.motion.motion - drawn.truth, drawn.motion);
    }
    const auto fused = estimator.update(drawn.radar, drawn.motion);
    if (fused && fused->has_estimate()) {
      outcome.fused.add(fused->motion - vehicle.truth(*fused), *fused);
      outcome.gaps += reached_us != 0 && fused->utime_start_us != reached_us ? 1 : 0;
      reached_us = fused->utime_us;
    }
  }
}

// Less than 0.8 where a vehicle that stands or keeps its speed might have accelerated between two
// radars' scans, as far as they know.
TEST_CASE("fused: in every regime credible, and better than any radar alone") {
  const auto regime =
      GENERATE(Regime{"standing", 2, standing, 0.5}, Regime{"straight", 2, simulation::straight_on},
               Regime{"bends", 2, simulation::in_bends}, Regime{"braking", 2, braking},
               Regime{"reversing", 2, reversing, 0.75}, Regime{"standing", 3, standing, 0.65},
               Regime{"straight", 3, simulation::straight_on, 0.75}, Regime{"skid", 3, skidding},
               Regime{"braking", 3, braking});
  const std::size_t radars = GENERATE(1U, 2U, 5U);
  Outcome outcome{{}, std::vector<Errors>(radars), 0};
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    drive(regime, radars, seed, outcome);
  }
  const Eigen::Vector3d rms = outcome.fused.rms();
  const Eigen::Vector3d axes = outcome.fused.axes / outcome.fused.count;
  std::printf("%-9s %d DoF, %zu radars: ANEES %.2f (%.2f %.2f %.2f)\n", regime.name,
              regime.degrees_of_freedom, radars, outcome.fused.anees(), axes.x(), axes.y(),
              axes.z());
  CAPTURE(regime.name, regime.degrees_of_freedom, radars, axes.transpose());
  CHECK(outcome.gaps == 0);
  CHECK(outcome.fused.count >= kSeeds * 260);
  CHECK(outcome.fused.anees() >= regime.min_anees);
  CHECK(outcome.fused.anees() <= 1.25);
  if (radars > 1) {
    for (const Errors& single : outcome.single) {
      CHECK(rms.x() < single.rms().x());
      CHECK(rms.z() < single.rms().z());
      CHECK((regime.degrees_of_freedom == 2 || rms.y() < single.rms().y()));
    }
  }
}

TEST_CASE("fused: a car's slip is learned, and its y credible from then on") {
  EgoMotionOptions options = drawn_options(2);
  options.registration.shared_errors.mount_yaw_std_rad = 0.0;  // All of y is slip.
  const Course course = [](double) { return Eigen::Vector3d(12.0, 0.12, 0.0); };
  Errors fused_errors;
  double sum_m = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    DrawnVehicle vehicle(course, drawn_radars(3), options, seed);
    FusedEstimator estimator({}, options, 3);
    while (vehicle.time_s() < 20.0) {
      const DrawnMotion drawn = vehicle.next();
      const auto fused = estimator.update(drawn.radar, drawn.motion);
      if (fused && fused->has_estimate() && vehicle.time_s() > 10.0) {
        fused_errors.add(fused->motion - vehicle.truth(*fused), *fused);
        sum_m += fused->motion.y();
      }
    }
  }
  const double y_nees = fused_errors.axes.y() / fused_errors.count;
  CAPTURE(y_nees);
  CHECK(sum_m / fused_errors.count == Approx(0.12 * 0.075).epsilon(0.1));
  CHECK(y_nees > 0.4);  // It might have changed.
  CHECK(y_nees < 1.5);
  CHECK(fused_errors.rms().y() < 0.06);  // m/s: half of the slip.
}

}  // namespace
}  // namespace cremed
