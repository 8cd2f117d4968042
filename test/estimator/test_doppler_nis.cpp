// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause

// The NIS of positions against Doppler in a registration's result.

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "cremed/estimator/registration/registration.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using simulation::Detections;
using simulation::kShortDt;
using simulation::Random;

const Pose2 kAskew{3.4, 0.5, 0.3};

/// The systematic errors of SharedDoppler.
struct Shared {
  double offset_mps = 0.0;
  double mount_rad = 0.0;
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();
};

Shared draw(const RegistrationOptions& options, Random& random) {
  const SharedErrorOptions& errors = options.shared_errors;
  std::normal_distribution<double> normal;
  Shared shared;
  shared.offset_mps = errors.doppler_offset_std_mps * normal(random);
  shared.mount_rad = errors.mount_yaw_std_rad * normal(random);
  shared.acceleration.x() = errors.acceleration_std_mps2 * normal(random);
  shared.acceleration.y() =
      options.degrees_of_freedom == 3 ? errors.acceleration_std_mps2 * normal(random) : 0.0;
  shared.acceleration.z() = errors.yaw_acceleration_std_radps2 * normal(random);
  return shared;
}

/// Their Doppler as the model predicts it, at a velocity in the vehicle's frame.
void set_doppler(Detections& detections, const Eigen::Vector3d& velocity, const Shared& shared) {
  for (Detection& detection : detections) {
    const double angle_rad = detection.azimuth_rad + kAskew.yaw_rad + shared.mount_rad;
    detection.doppler_mps = -(velocity.x() - velocity.z() * kAskew.y_m) * std::cos(angle_rad) -
                            (velocity.y() + velocity.z() * kAskew.x_m) * std::sin(angle_rad) +
                            shared.offset_mps;
  }
}

RegistrationOptions nis_options(int degrees_of_freedom, bool both_scans, bool with_shared) {
  RegistrationOptions options = simulation::paper_options();
  options.degrees_of_freedom = degrees_of_freedom;
  options.doppler.both_scans = both_scans;
  if (with_shared) {
    options.shared_errors = SharedErrorOptions();
    options.shared_errors.velocity_std_mps = 0.0;  // Not observable.
    options.shared_errors.doppler_scale_std = 0.0;
  }
  return options;
}

struct Pair {
  Eigen::Vector3d motion;
  RegistrationResult result;
};

/// With two degrees of freedom y = 0, or the y of an arc.
Pair solve_pair(const RegistrationOptions& options, Random& random, bool is_arc = false) {
  const bool is_car = options.degrees_of_freedom == 2;
  const simulation::Noise noise{0.13, 0.0157, 0.1};
  Eigen::Vector3d motion(simulation::uniform(random, 0.5, 1.5),
                         is_car ? 0.0 : simulation::uniform(random, -0.2, 0.2),
                         simulation::uniform(random, -0.05, 0.05));
  Eigen::Vector3d half_way = motion;  // Frame half way through the turn.
  if (is_arc) {
    motion.y() = 0.5 * motion.x() * motion.z();
  }
  if (!is_car) {
    half_way.head<2>() = Eigen::Rotation2Dd(-0.5 * motion.z()) * motion.head<2>();
  }
  const auto points = simulation::scatter(random, 40, 5.0, 40.0, 1.0, 1.0);
  Detections previous =
      simulation::observe_all(points, Eigen::Vector3d::Zero(), kShortDt, kAskew, noise);
  Detections current = simulation::observe_all(points, motion, kShortDt, kAskew, noise);
  const Shared shared = draw(options, random);
  set_doppler(previous, (half_way / kShortDt) - 0.5 * kShortDt * shared.acceleration, shared);
  set_doppler(current, (half_way / kShortDt) + 0.5 * kShortDt * shared.acceleration, shared);
  simulation::perturb(previous, random);
  simulation::perturb(current, random);
  Registration registration(options, kAskew);
  registration.set_previous(simulation::targets(previous, kAskew));
  return {motion, registration.solve(simulation::targets(current, kAskew), kShortDt)};
}

TEST_CASE("registration: positions and Doppler differ as their covariances state") {
  const bool both_scans = GENERATE(false, true);
  const bool with_shared = GENERATE(false, true);
  const RegistrationOptions options = nis_options(2, both_scans, with_shared);
  CAPTURE(both_scans, with_shared);
  Random random(7);
  constexpr int kPairs = 300;
  double sum = 0.0;
  int count = 0;
  for (int i = 0; i < kPairs; ++i) {
    const RegistrationResult result = solve_pair(options, random).result;
    if (std::isfinite(result.doppler_nis)) {
      sum += result.doppler_nis;
      ++count;
    }
  }
  CHECK(count > kPairs * 95 / 100);
  CHECK(sum / count > 0.8);
  CHECK(sum / count < 1.2);
}

TEST_CASE("registration: without Doppler, or with max_sum_mixture, there is no NIS") {
  Random random(5);
  RegistrationOptions options = nis_options(2, true, false);
  options.doppler.enabled = false;
  CHECK(std::isnan(solve_pair(options, random).result.doppler_nis));
  options = nis_options(2, false, false);
  CHECK_FALSE(std::isnan(solve_pair(options, random).result.doppler_nis));
  // One radar's Doppler observes two of three states.
  CHECK(std::isnan(solve_pair(nis_options(3, true, true), random).result.doppler_nis));
  options.likelihood = Likelihood::max_sum_mixture;
  const RegistrationResult result = solve_pair(options, random).result;
  CHECK(result.status == RegistrationStatus::converged);
  CHECK(std::isnan(result.doppler_nis));
}

}  // namespace
}  // namespace cremed
