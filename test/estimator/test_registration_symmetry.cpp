// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <memory>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "cremed/estimator/registration/registration.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using numeric::radians;
using simulation::Detections;
using simulation::kDt;
using simulation::Random;
using simulation::uniform;

/// Two noisy scans of one radar in its own frame.
struct ScanPair {
  Detections previous;
  Detections current;
};

/// As seen by a radar at the vehicle's origin. `bound`: largest translation in m; the largest yaw
/// in degrees is ten times that.
ScanPair random_pair(Random& random, double bound_m) {
  const simulation::Points points = simulation::scatter(random, 25, 5.0, 35.0, radians(50.0), 4.0);
  const Eigen::Vector3d motion{uniform(random, -bound_m, bound_m),
                               uniform(random, -bound_m, bound_m),
                               radians(10.0 * uniform(random, -bound_m, bound_m))};
  ScanPair pair{simulation::observe_all(points, Eigen::Vector3d::Zero(), kDt, {}, {}),
                simulation::observe_all(points, motion, kDt, {}, {})};
  simulation::perturb(pair.previous, random);
  simulation::perturb(pair.current, random);
  return pair;
}

std::unique_ptr<Registration> prepare(const RegistrationOptions& options, const Pose2& mount,
                                      const Detections& previous) {
  auto registration = std::make_unique<Registration>(options, mount);
  registration->set_previous(simulation::targets(previous, mount));
  return registration;
}

RegistrationResult result_of(const RegistrationOptions& options, const Pose2& mount,
                             const ScanPair& pair) {
  return prepare(options, mount, pair.previous)
      ->solve(simulation::targets(pair.current, mount), kDt);
}

/// Composition: a after b.
Eigen::Vector3d compose(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector2d t = simulation::seen_from(simulation::inverse(a), b.head<2>());
  return {t.x(), t.y(), a.z() + b.z()};
}

bool is_identical(const RegistrationResult& a, const RegistrationResult& b) {
  return a.status == b.status && a.iterations == b.iterations && a.cost == b.cost &&
         a.motion == b.motion && a.covariance == b.covariance;
}

TEST_CASE("the motion of another point of the vehicle follows from the mount") {
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    const ScanPair pair = random_pair(random, 0.3);
    const Pose2 mount{uniform(random, -1.0, 4.0), uniform(random, -1.0, 1.0),
                      uniform(random, -3.1, 3.1)};
    const RegistrationOptions options = simulation::paper_options(3, false);
    const RegistrationResult at_radar = result_of(options, {}, pair);
    const RegistrationResult at_vehicle = result_of(options, mount, pair);
    // T m T^-1, m being the radar's motion and T the mount.
    const Eigen::Vector3d pose = simulation::as_vector(mount);
    const Eigen::Vector3d expected =
        compose(compose(pose, at_radar.motion), simulation::inverse(pose));
    CHECK(at_vehicle.cost == Approx(at_radar.cost).epsilon(1e-3));
    CHECK(numeric::normalised_error(at_vehicle.motion - expected, at_vehicle.covariance, 3) <
          0.1 * 0.1);
    CHECK(at_vehicle.covariance(2, 2) == Approx(at_radar.covariance(2, 2)).epsilon(1e-3));
  }
}

TEST_CASE("a turned vehicle frame turns the motion, with Doppler as well") {
  Random random(2);
  for (int i = 0; i < 20; ++i) {
    const ScanPair pair = random_pair(random, 0.3);
    const double turn_rad = uniform(random, -3.1, 3.1);
    const RegistrationResult straight = result_of(simulation::paper_options(3, true), {}, pair);
    const RegistrationResult turned =
        result_of(simulation::paper_options(3, true), {0.0, 0.0, turn_rad}, pair);
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    rotation.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(turn_rad).toRotationMatrix();
    CHECK((turned.motion - rotation * straight.motion).norm() < 1e-9);
    // The probabilities of pairs amplify a difference of the motion hundreds of times.
    CHECK((turned.covariance - rotation * straight.covariance * rotation.transpose()).norm() <
          1e-5 * straight.covariance.norm());
    CHECK(turned.cost == Approx(straight.cost));
    CHECK(turned.iterations == straight.iterations);
  }
}

TEST_CASE("the yaw by positions alone is credible, also if the mount is turned") {
  Random random(6);
  const Pose2 mount{3.4, 0.0, 0.0};
  RegistrationOptions options = simulation::paper_options(2, true);
  options.likelihood = Likelihood::exclusive;
  for (const double turned_rad : {0.0, 0.06}) {
    double nees = 0.0;
    double nees_with_doppler = 0.0;
    constexpr int kPairs = 100;
    for (int i = 0; i < kPairs; ++i) {
      const simulation::Points points =
          simulation::scatter(random, 60, 5.0, 35.0, radians(50.0), 3.0);
      const Eigen::Vector3d motion{0.6, 0.0, uniform(random, -0.02, 0.02)};
      ScanPair pair{simulation::observe_all(points, Eigen::Vector3d::Zero(), kDt, mount, {}),
                    simulation::observe_all(points, motion, kDt, mount, {})};
      simulation::perturb(pair.previous, random);
      simulation::perturb(pair.current, random);
      const RegistrationResult result =
          result_of(options, {mount.x_m, mount.y_m, mount.yaw_rad - turned_rad}, pair);
      nees += std::pow(result.by_positions.rad - motion.z(), 2) / result.by_positions.variance_rad2;
      nees_with_doppler += std::pow(result.motion.z() - motion.z(), 2) / result.covariance(2, 2);
    }
    // 5 sigma of the mean of so many.
    CHECK(nees / kPairs == Approx(1.0).margin(0.7));
    // Without sideways motion a turned mount is taken for a turn by Doppler.
    CHECK((nees_with_doppler / kPairs > 5.0) == (turned_rad > 0.0));
  }
}

TEST_CASE("mirrored scans give the mirrored motion") {
  Random random(3);
  const auto mirror = [](Detections detections) {
    for (Detection& detection : detections) {
      detection.azimuth_rad = -detection.azimuth_rad;
    }
    return detections;
  };
  const Eigen::Vector3d sign(1.0, -1.0, -1.0);
  for (const int degrees_of_freedom : {2, 3}) {
    const RegistrationOptions options = simulation::paper_options(degrees_of_freedom, true);
    for (int i = 0; i < 10; ++i) {
      const ScanPair pair = random_pair(random, 0.3);
      const RegistrationResult direct = result_of(options, {3.0, 0.7, 0.4}, pair);
      const RegistrationResult mirrored =
          result_of(options, {3.0, -0.7, -0.4}, {mirror(pair.previous), mirror(pair.current)});
      CHECK((mirrored.motion - direct.motion.cwiseProduct(sign)).norm() < 1e-12);
      const Eigen::Matrix3d covariance = sign.asDiagonal() * direct.covariance * sign.asDiagonal();
      CHECK((mirrored.covariance - covariance).norm() < 1e-9 * covariance.norm());
    }
  }
}

TEST_CASE("the order of the targets changes rounding only") {
  Random random(4);
  for (int i = 0; i < 10; ++i) {
    ScanPair pair = random_pair(random, 0.3);
    const RegistrationResult before = result_of(simulation::paper_options(3, true), {}, pair);
    std::shuffle(pair.previous.begin(), pair.previous.end(), random);
    std::shuffle(pair.current.begin(), pair.current.end(), random);
    const RegistrationResult after = result_of(simulation::paper_options(3, true), {}, pair);
    CHECK((after.motion - before.motion).norm() < 1e-9);
    CHECK((after.covariance - before.covariance).norm() < 1e-9 * before.covariance.norm());
  }
}

TEST_CASE("the same input gives bit-identical results, independent of earlier calls") {
  Random random(5);
  for (int i = 0; i < 10; ++i) {
    const ScanPair pair = random_pair(random, 0.3);
    ScanPair other = random_pair(random, 0.5);
    other.previous.insert(other.previous.end(), pair.current.begin(), pair.current.end());
    const TargetSet current = simulation::targets(pair.current, {});
    const auto used = prepare(simulation::paper_options(2, true), {}, pair.previous);
    const RegistrationResult first = used->solve(current, kDt);
    CHECK(is_identical(first, used->solve(current, kDt)));
    CHECK(is_identical(first, result_of(simulation::paper_options(2, true), {}, pair)));

    Detections broken = other.current;
    broken[0].range_m = numeric::kNan;
    used->set_previous(simulation::targets(other.previous, {}));
    used->solve(simulation::targets(other.current, {}), kDt);
    used->solve(simulation::targets(broken, {}), kDt);
    used->solve(current, 0.5);
    used->set_previous(simulation::targets(pair.previous, {}));
    CHECK(is_identical(first, used->solve(current, kDt)));
  }
}

TEST_CASE("the solution on a mixture is a minimum of linearise") {
  Random random(6);
  for (int i = 0; i < 20; ++i) {
    const ScanPair pair = random_pair(random, 0.3);
    const TargetSet current = simulation::targets(pair.current, {});
    RegistrationOptions options = simulation::paper_options(3, true);
    options.likelihood = Likelihood::max_sum_mixture;
    const auto registration = prepare(options, {}, pair.previous);
    const RegistrationResult result = registration->solve(current, kDt);
    const auto cost =
        simulation::mixture_cost(options, {}, simulation::targets(pair.previous, {}), current, kDt);
    const NormalEquations there = cost->linearise({result.motion});
    CHECK(there.cost == result.cost);
    CHECK((there.information * result.covariance - Eigen::Matrix3d::Identity()).norm() < 1e-9);
    // The next step in standard deviations. Gauss-Newton neglects terms of this size.
    CHECK(there.gradient.dot(result.covariance * there.gradient) < 0.1 * 0.1);
    CHECK(result.cost < cost->linearise({}).cost);
  }
}

}  // namespace
}  // namespace cremed
