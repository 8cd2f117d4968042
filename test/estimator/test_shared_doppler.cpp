// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "cremed/estimator/cost/driving_share.hpp"
#include "cremed/estimator/cost/shared_doppler.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using numeric::radians;
using simulation::kPeriodS;
using simulation::no_shared_errors;
using simulation::Random;
using simulation::uniform;

const Pose2 kSharedMount{3.4, 0.3, 0.1};

DopplerOptions no_movers() {
  DopplerOptions options;
  options.moving_weight = 0.0;
  options.stamp_std_s = 0.0;
  return options;
}

SharedDoppler shared_doppler(const DopplerOptions& doppler, const SharedErrorOptions& errors,
                             const Pose2& mount, int degrees_of_freedom = 2) {
  return {degrees_of_freedom, doppler, errors, mount};
}

/// Static targets while the vehicle moves with `velocity`. Each Doppler has an error of `noise_mps`
/// times a number between -1 and 1.
TargetSet seen(const Eigen::Vector3d& velocity, const Pose2& mount, int count, double noise_mps,
               std::uint64_t seed, double half_view_rad = radians(50.0)) {
  Random random(seed);
  TargetSet set;
  for (int i = 0; i < count; ++i) {
    Detection detection;
    detection.range_m = uniform(random, 5.0, 60.0);
    detection.azimuth_rad = uniform(random, -half_view_rad, half_view_rad);
    const double bearing_rad = detection.azimuth_rad + mount.yaw_rad;
    detection.doppler_mps = -(velocity.x() - velocity.z() * mount.y_m) * std::cos(bearing_rad) -
                            (velocity.y() + velocity.z() * mount.x_m) * std::sin(bearing_rad) +
                            noise_mps * uniform(random, -1.0, 1.0);
    detection.range_std_m = 0.2;
    detection.azimuth_std_rad = 1e-4;
    detection.doppler_std_mps = 0.1;
    set.add(detection, mount);
  }
  return set;
}

/// Newton's method on Doppler alone, (x, yaw) free. Returns the motion and its covariance.
struct Solution {
  Eigen::Vector3d motion = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

Solution solve_doppler(const SharedDoppler& doppler, const TargetSet& previous,
                       const TargetSet& current) {
  Unknowns at;
  Solution solution;
  for (int i = 0; i < 20; ++i) {
    const NormalEquations equations = doppler.linearise(previous, current, kPeriodS, at);
    const auto inverse = invert_information(equations.information, 2);
    REQUIRE(inverse);
    solution.covariance = *inverse;
    at = {at.motion - *inverse * equations.gradient, equations.shared};
  }
  solution.motion = at.motion;
  return solution;
}

TEST_CASE("Marginalising the shared errors gives the same as solving for all unknowns") {
  // All seven unknowns at once, by numeric derivatives of the residuals that the header states.
  const SharedErrorOptions errors{0.05, 0.01, 0.0, 0.0, 2.0, 0.5};
  const Eigen::Vector3d motion(0.6, 0.0, 0.01);
  const TargetSet previous = seen({7.9, 0.0, 0.10}, kSharedMount, 30, 0.1, 1);
  const TargetSet current = seen({8.2, 0.0, 0.13}, kSharedMount, 40, 0.1, 2);
  using Unknowns = Eigen::Matrix<double, 7, 1>;  // x, y, yaw, b, d, a, w
  const auto error_m = [&](const Target& target, double side, const Unknowns& u) {
    const double half = side * 0.5 * kPeriodS * kPeriodS;
    const Eigen::Vector3d at = u.head<3>() + half * Eigen::Vector3d(u(5), 0.0, u(6));
    const double bearing = target.bearing_rad + u(4);
    return -(at.x() - at.z() * kSharedMount.y_m) * std::cos(bearing) -
           (at.y() + at.z() * kSharedMount.x_m) * std::sin(bearing) -
           target.doppler_mps * kPeriodS + kPeriodS * u(3);
  };
  Unknowns start = Unknowns::Zero();
  start.head<3>() = motion;
  Eigen::Matrix<double, 7, 7> information = Eigen::Matrix<double, 7, 7>::Zero();
  Unknowns gradient = Unknowns::Zero();
  information.diagonal().tail<4>() << 1 / (0.05 * 0.05), 1 / (0.01 * 0.01), 1 / 4.0, 1 / 0.25;
  for (const double side : {-1.0, 1.0}) {
    for (const Target& target : side < 0.0 ? previous : current) {
      Unknowns jacobian;
      for (int k = 0; k < 7; ++k) {
        const Unknowns step = 1e-5 * Unknowns::Unit(k);
        jacobian(k) =
            (error_m(target, side, start + step) - error_m(target, side, start - step)) / 2e-5;
      }
      const double per_bearing_m =
          (motion.x() - motion.z() * kSharedMount.y_m) * target.sin_bearing -
          motion.z() * kSharedMount.x_m * target.cos_bearing;
      const double bearing_m = per_bearing_m * target.bearing_std_rad;
      const double weight =
          1.0 / (std::pow(kPeriodS * target.doppler_std_mps, 2) + bearing_m * bearing_m);
      information += weight * jacobian * jacobian.transpose();
      gradient += weight * error_m(target, side, start) * jacobian;
    }
  }
  // A radar in front cannot separate y from yaw: x and yaw only.
  const std::vector<int> free{0, 2, 3, 4, 5, 6};
  const Eigen::Matrix<double, 6, 6> covariance = information(free, free).inverse();
  const Eigen::Matrix<double, 6, 1> step = -covariance * gradient(free);

  const SharedDoppler doppler = shared_doppler(no_movers(), errors, kSharedMount);
  const NormalEquations equations = doppler.linearise(previous, current, kPeriodS, {motion});
  const auto inverse = invert_information(equations.information, 2);
  REQUIRE(inverse);
  const Eigen::Vector3d found = -*inverse * equations.gradient;
  CHECK((*inverse)(0, 0) == Approx(covariance(0, 0)).epsilon(1e-5));
  CHECK((*inverse)(0, 2) == Approx(covariance(0, 1)).epsilon(1e-5));
  CHECK((*inverse)(2, 2) == Approx(covariance(1, 1)).epsilon(1e-5));
  CHECK(found.x() == Approx(step(0)).epsilon(1e-5));
  CHECK(found.z() == Approx(step(1)).epsilon(1e-5));
}

TEST_CASE("The gradient is the derivative of the cost") {
  const SharedErrorOptions errors{0.05, 0.0, 0.0, 0.0, 2.0, 0.5};
  const TargetSet previous = seen({7.9, 0.0, 0.10}, kSharedMount, 30, 0.1, 3);
  const TargetSet current = seen({8.2, 0.0, 0.13}, kSharedMount, 40, 0.1, 4);
  const SharedDoppler doppler = shared_doppler(no_movers(), errors, kSharedMount);
  const auto equations_at = [&](const Eigen::Vector3d& motion) {
    return doppler.linearise(previous, current, kPeriodS, {motion});
  };
  const Eigen::Vector3d motion(0.62, 0.0, 0.012);
  const Eigen::Vector3d expected = numeric::central_differences(
      motion, 1e-6, [&](const Eigen::Vector3d& at) { return equations_at(at).cost; });
  // The gradient neglects the weight's dependence on the motion by the bearing's noise.
  CHECK((equations_at(motion).gradient - expected).norm() < 1e-3 * expected.norm());
}

TEST_CASE("A common offset of all targets does not average out") {
  SharedErrorOptions errors = no_shared_errors();
  errors.doppler_offset_std_mps = 0.05;
  const SharedDoppler with = shared_doppler(no_movers(), errors, {3.4, 0.0, 0.0});
  const SharedDoppler without = shared_doppler(no_movers(), no_shared_errors(), {3.4, 0.0, 0.0});
  const double narrow_rad = radians(10.0);  // A wide view would separate offset from speed.
  for (const int count : {10, 50, 250}) {
    CAPTURE(count);
    const TargetSet scan = seen({8.0, 0.0, 0.0}, {3.4, 0.0, 0.0}, count, 0.1, 5, narrow_rad);
    CHECK(std::sqrt(solve_doppler(with, scan, scan).covariance(0, 0)) > 0.95 * 0.05 * kPeriodS);
    CHECK(std::sqrt(solve_doppler(without, scan, scan).covariance(0, 0)) <
          1.1 * 0.1 * kPeriodS / std::sqrt(2.0 * count));
  }
}

TEST_CASE("While the vehicle stands there is no offset") {
  SharedErrorOptions errors = no_shared_errors();
  errors.doppler_offset_std_mps = 0.05;
  const SharedDoppler doppler = shared_doppler(no_movers(), errors, {3.4, 0.0, 0.0});
  const TargetSet scan = seen(Eigen::Vector3d::Zero(), {3.4, 0.0, 0.0}, 100, 0.1, 6, 0.2);
  const NormalEquations equations = doppler.linearise(scan, scan, kPeriodS, {});
  CHECK(equations.information(0, 0) > 0.9 * 200.0 / std::pow(0.1 * kPeriodS, 2));
}

TEST_CASE("An accelerating vehicle: both scans give the mean speed, one a wider covariance") {
  SharedErrorOptions errors = no_shared_errors();
  errors.acceleration_std_mps2 = 3.0;
  errors.yaw_acceleration_std_radps2 = 0.5;
  const TargetSet previous = seen({8.0, 0.0, 0.10}, kSharedMount, 60, 0.0, 7);
  const TargetSet current = seen({8.3, 0.0, 0.16}, kSharedMount, 90, 0.0, 8);
  const Eigen::Vector3d mean = kPeriodS * Eigen::Vector3d(8.15, 0.0, 0.13);

  const SharedDoppler both = shared_doppler(no_movers(), errors, kSharedMount);
  const Solution solution = solve_doppler(both, previous, current);
  CHECK((solution.motion - mean).norm() < 2e-4);
  CHECK(std::sqrt(solution.covariance(0, 0)) < 0.002);

  DopplerOptions options = no_movers();
  options.both_scans = false;
  const SharedDoppler one = shared_doppler(options, errors, kSharedMount);
  const Solution alone = solve_doppler(one, previous, current);
  CHECK(alone.motion.x() == Approx(kPeriodS * 8.3).margin(5e-4));
  const double sigma_m = std::sqrt(alone.covariance(0, 0));
  CHECK(sigma_m > 0.9 * 0.5 * 3.0 * kPeriodS * kPeriodS);
  CHECK(std::abs(alone.motion.x() - mean.x()) < 3.0 * sigma_m);
}

TEST_CASE("A skid: the frame turns between the scans, and the vehicle accelerates sideways") {
  SharedErrorOptions errors = no_shared_errors();
  errors.acceleration_std_mps2 = 5.0;
  errors.yaw_acceleration_std_radps2 = 0.5;
  // One radar cannot separate yaw from y; with the yaw given, it finds y.
  const TargetSet previous = seen({10.0, -1.9, 0.5}, kSharedMount, 60, 0.0, 10);
  const TargetSet current = seen({10.0, -2.1, 0.5}, kSharedMount, 90, 0.0, 11);
  const double turn_rad = 0.5 * kPeriodS;
  Eigen::Vector3d expected(10.0 * kPeriodS, -2.0 * kPeriodS, turn_rad);
  expected.head<2>() = Eigen::Rotation2Dd(0.5 * turn_rad) * expected.head<2>();

  const SharedDoppler doppler = shared_doppler(no_movers(), errors, kSharedMount, 3);
  Unknowns at{{0.7, 0.0, turn_rad}};
  for (int i = 0; i < 20; ++i) {
    NormalEquations equations = doppler.linearise(previous, current, kPeriodS, at);
    equations.information(2, 2) += 1e12;
    equations.gradient.z() += 1e12 * (at.motion.z() - turn_rad);
    const auto inverse = invert_information(equations.information, 3);
    REQUIRE(inverse);
    at = {at.motion - *inverse * equations.gradient, equations.shared};
  }
  CHECK((at.motion - expected).norm() < 5e-4);
}

TEST_CASE("The driving share is the speed beyond noise") {
  const Eigen::Vector3d forward(0.01, 0.0, 0.0);
  const auto share = [](const Eigen::Vector3d& motion, double noise_m) {
    return driving_share(speed_beyond_noise_mps(motion, noise_m, 0.1));
  };
  CHECK(share(Eigen::Vector3d::Zero(), 0.0) == 0.0);
  CHECK(share(forward, 0.02) == 0.0);
  CHECK(share(forward, 0.0) == Approx(0.1));
  CHECK(share(-forward, 0.005) == Approx(0.05));
  CHECK(share(100.0 * forward, 0.005) == 1.0);
  CHECK(driving_share(-0.5) == 0.5);
}

TEST_CASE("A small yaw error of the mount biases yaw within its covariance") {
  SharedErrorOptions errors = no_shared_errors();
  errors.mount_yaw_std_rad = 0.01;
  const Pose2 configured{3.4, 0.0, 0.0};
  const Pose2 true_mount{3.4, 0.0, 0.01};
  TargetSet scan;
  Random random(9);
  for (int i = 0; i < 200; ++i) {
    Detection detection;
    detection.range_m = 30.0;
    detection.azimuth_rad = uniform(random, -0.9, 0.9);
    detection.doppler_mps = -8.0 * std::cos(detection.azimuth_rad + true_mount.yaw_rad);
    detection.range_std_m = 0.2;
    detection.azimuth_std_rad = 1e-4;
    detection.doppler_std_mps = 0.1;
    scan.add(detection, configured);
  }
  const SharedDoppler naive = shared_doppler(no_movers(), no_shared_errors(), configured);
  const SharedDoppler aware = shared_doppler(no_movers(), errors, configured);
  const Solution wrong = solve_doppler(naive, scan, scan);
  const Solution right = solve_doppler(aware, scan, scan);
  CHECK(std::abs(wrong.motion.z()) > 5.0 * std::sqrt(wrong.covariance(2, 2)));
  CHECK(std::abs(right.motion.z()) < 2.0 * std::sqrt(right.covariance(2, 2)));
}

}  // namespace
}  // namespace cremed
