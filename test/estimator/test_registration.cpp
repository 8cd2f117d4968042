// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "cremed/estimator/registration/registration.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/scenario.hpp"

namespace cremed {
namespace {

using numeric::radians;
using simulation::Detections;
using simulation::isotropic;
using simulation::kDt;
using simulation::kModels;
using simulation::Noise;
using simulation::paper_options;
using simulation::Points;
using simulation::Random;
using simulation::solve;
using simulation::uniform;

struct Regime {
  std::string name;
  Eigen::Vector3d motion;
};

/// Standstill, straight, pure yaw, nearly zero, and random; y only if it is estimated.
std::vector<Regime> regimes(int degrees_of_freedom) {
  std::vector<Regime> result = {{"standstill", {0.0, 0.0, 0.0}},
                                {"straight", {0.8, 0.0, 0.0}},
                                {"backwards", {-0.5, 0.0, 0.0}},
                                {"pure yaw", {0.0, 0.0, radians(6.0)}},
                                {"1e-8", {1e-8, 0.0, -1e-8}}};
  Random random(1);
  for (int i = 0; i < 10; ++i) {
    result.push_back(
        {"random", Eigen::Vector3d{uniform(random, -0.5, 1.0), uniform(random, -0.25, 0.25),
                                   radians(uniform(random, -8.0, 8.0))}});
  }
  for (Regime& regime : result) {
    if (degrees_of_freedom == 2) {
      regime.motion.y() = 0.0;
    } else if (regime.name == "straight") {
      regime.motion.y() = 0.3;
    }
  }
  return result;
}

const std::vector<Pose2> kMounts = {{}, {3.4, 0.5, 0.2}, {-0.6, -0.8, radians(150.0)}};

/// Points in the view of a radar at `mount`, far apart.
Points landmarks_in_view(Random& random, const Pose2& mount) {
  Points points = simulation::scatter(random, 25, 5.0, 35.0, radians(50.0), 4.0);
  for (Eigen::Vector2d& point : points) {
    point = simulation::as_vector(mount).head<2>() + Eigen::Rotation2Dd(mount.yaw_rad) * point;
  }
  return points;
}

/// The paper uses motion / time as the velocity. In fact the vehicle frame turns, and the constant
/// velocity in that frame is the motion in the frame half way through the turn.
Eigen::Vector3d half_way(Eigen::Vector3d motion) {
  motion.head<2>() = Eigen::Rotation2Dd(-0.5 * motion.z()) * motion.head<2>();
  return motion;
}

void set_exact_doppler(Detections& detections, const Eigen::Vector3d& velocity,
                       const Pose2& mount) {
  const Eigen::Vector2d sensor_velocity(velocity.x() - velocity.z() * mount.y_m,
                                        velocity.y() + velocity.z() * mount.x_m);
  for (Detection& detection : detections) {
    const double bearing_rad = detection.azimuth_rad + mount.yaw_rad;
    detection.doppler_mps =
        -sensor_velocity.dot(Eigen::Vector2d(std::cos(bearing_rad), std::sin(bearing_rad)));
  }
}

/// Runs `check` for every regime, mount, number of states, with and without Doppler, on data
/// without noise.
template <typename Check>
void for_all_regimes(const Check& check) {
  Random random(2);
  for (const int degrees_of_freedom : {2, 3}) {
    for (const Regime& regime : regimes(degrees_of_freedom)) {
      for (const Pose2& mount : kMounts) {
        for (const bool has_doppler : {false, true}) {
          CAPTURE(degrees_of_freedom, regime.name, mount.yaw_rad, has_doppler,
                  regime.motion.transpose());
          const Points points = landmarks_in_view(random, mount);
          const Detections previous =
              simulation::observe_all(points, Eigen::Vector3d::Zero(), kDt, mount, {});
          for (const Likelihood model : kModels) {
            CAPTURE(model);
            Detections current = simulation::observe_all(points, regime.motion, kDt, mount, {});
            if (degrees_of_freedom == 3 && model == Likelihood::exclusive) {
              set_exact_doppler(current, half_way(regime.motion) / kDt, mount);
            }
            check(paper_options(degrees_of_freedom, has_doppler, model), mount, previous, current,
                  regime.motion);
          }
        }
      }
    }
  }
}

TEST_CASE("data without noise give the true motion") {
  for_all_regimes([](const RegistrationOptions& options, const Pose2& mount,
                     const Detections& previous, const Detections& current,
                     const Eigen::Vector3d& motion) {
    const RegistrationResult result = solve(options, previous, current, kDt, mount);
    REQUIRE(result.status == RegistrationStatus::converged);
    CHECK(result.iterations <= 30);
    // A fraction of a standard deviation: bias by neighbouring targets, and the step tolerance.
    const Eigen::Vector3d error = result.motion - motion;
    CHECK(std::sqrt(numeric::normalised_error(error, result.covariance,
                                              options.degrees_of_freedom)) < 0.02);
    if (options.degrees_of_freedom == 2) {
      CHECK(result.motion.y() == 0.0);
    }
  });
}

TEST_CASE("the covariance is symmetric, positive definite, and zero for states not estimated") {
  for_all_regimes([](const RegistrationOptions& options, const Pose2& mount,
                     const Detections& previous, const Detections& current,
                     const Eigen::Vector3d&) {
    const Eigen::Matrix3d covariance = solve(options, previous, current, kDt, mount).covariance;
    const Eigen::Vector3d sigma = covariance.diagonal().cwiseSqrt();
    CHECK(covariance == covariance.transpose());
    const Eigen::Vector3d eigenvalues = numeric::eigenvalues(covariance);
    if (options.degrees_of_freedom == 2) {
      CHECK(covariance.row(1).isZero(0.0));
      CHECK(covariance.col(1).isZero(0.0));
      CHECK(eigenvalues(1) > 0.0);
      CHECK(eigenvalues(0) == Approx(0.0).margin(1e-18));
    } else {
      CHECK(eigenvalues(0) > 0.0);
      CHECK(sigma.y() < 0.3);
    }
    CHECK(sigma.x() > 1e-3);
    CHECK(sigma.x() < 0.3);
    CHECK(sigma.z() > 1e-4);
    CHECK(sigma.z() < 0.03);
  });
}

TEST_CASE("targets far apart have the covariance of known correspondences") {
  const double std_m = 0.1;
  const Points points = {{10.0, 3.0}, {30.0, -8.0}, {18.0, 15.0}, {6.0, -9.0}};
  const Detections scan =
      isotropic(simulation::observe_all(points, Eigen::Vector3d::Zero(), kDt, {}, {}), std_m);
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector2d& point : points) {
    Eigen::Matrix<double, 2, 3> jacobian;
    jacobian << 1.0, 0.0, -point.y(), 0.0, 1.0, point.x();
    information += jacobian.transpose() * jacobian / (2.0 * std_m * std_m);
  }
  const Eigen::Matrix3d expected = information.inverse();
  for (const Likelihood model : kModels) {
    RegistrationOptions options = paper_options(3, false, model);
    options.outlier_ray.weight = 0.0;
    const Eigen::Matrix3d actual = solve(options, scan, scan).covariance;
    CHECK((actual - expected).norm() < 1e-6 * expected.norm());
  }
}

TEST_CASE("Gauss-Newton's gradient is the derivative of the cost where covariances do not turn") {
  Random random(3);
  for (const bool has_doppler : {false, true}) {
    for (const Pose2& mount : kMounts) {
      const Points points = landmarks_in_view(random, mount);
      const Noise noise{0.1, 0.0, 20.0};  // Doppler noise dominates that of the bearing
      const auto observe = [&](const Eigen::Vector3d& motion) {
        return simulation::targets(
            isotropic(simulation::observe_all(points, motion, kDt, mount, noise), 0.1), mount);
      };
      const TargetSet previous = observe(Eigen::Vector3d::Zero());
      const TargetSet current = observe({0.3, 0.1, 0.05});
      for (int i = 0; i < 10; ++i) {
        const Eigen::Vector3d at{uniform(random, -0.5, 0.5), uniform(random, -0.5, 0.5),
                                 uniform(random, -0.1, 0.1)};
        for (const double scale : {1.0, 5.0}) {
          const auto cost = simulation::mixture_cost(paper_options(3, has_doppler), mount, previous,
                                                     current, kDt, scale);
          const Eigen::Vector3d expected = numeric::central_differences(
              at, 1e-6, [&](const Eigen::Vector3d& m) { return cost->linearise({m}).cost; });
          CAPTURE(has_doppler, mount.yaw_rad, scale, at.transpose());
          CHECK((cost->linearise({at}).gradient - expected).norm() <
                1e-4 * (1.0 + expected.norm()));
        }
      }
    }
  }
}

TEST_CASE("the scale of the first stage widens the current scan only") {
  const Points points = {{10.0, 3.0}, {30.0, -8.0}, {18.0, 15.0}};
  RegistrationOptions options = paper_options(3, false);
  options.outlier_ray.weight = 0.0;
  const Detections scan =
      isotropic(simulation::observe_all(points, Eigen::Vector3d::Zero(), kDt, {}, {}), 0.1);
  const TargetSet targets = simulation::targets(scan, {});
  const auto information = [&](double scale) {
    return simulation::mixture_cost(options, {}, targets, targets, kDt, scale)
        ->linearise({})
        .information;
  };
  // 1 + 1 without, 9 + 1 with the scale.
  CHECK((information(3.0) * 5.0 - information(1.0)).norm() < 1e-6 * information(1.0).norm());
}

TEST_CASE("swapped scans give the inverse motion") {
  Random random(4);
  for (int i = 0; i < 20; ++i) {
    const Pose2& mount = kMounts[static_cast<std::size_t>(i % 3)];
    const Points points = landmarks_in_view(random, mount);
    const Eigen::Vector3d motion{uniform(random, -0.5, 1.0), uniform(random, -0.3, 0.3),
                                 radians(uniform(random, -5.0, 5.0))};
    Detections a = simulation::observe_all(points, Eigen::Vector3d::Zero(), kDt, mount, {});
    Detections b = simulation::observe_all(points, motion, kDt, mount, {});
    simulation::perturb(a, random);
    simulation::perturb(b, random);
    for (const Likelihood model : kModels) {
      const RegistrationOptions options = paper_options(3, false, model);
      const RegistrationResult there = solve(options, a, b, kDt, mount);
      const RegistrationResult back = solve(options, b, a, kDt, mount);
      const Eigen::Vector3d error = simulation::inverse(back.motion) - there.motion;
      CAPTURE(model, motion.transpose(), error.transpose());
      CHECK(numeric::normalised_error(error, there.covariance, 3) < 0.2 * 0.2);
    }
  }
}

}  // namespace
}  // namespace cremed
