// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "cremed/estimator/cost/doppler.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using numeric::radians;
using simulation::kShortDt;
using simulation::Random;
using simulation::uniform;

struct NamedMount {
  const char* name;
  Pose2 pose;
};

const std::vector<NamedMount> kNamedMounts = {
    {"centre", {0.0, 0.0, 0.0}},           {"front", {3.4, 0.0, 0.0}},
    {"left", {2.4, 0.8, radians(90.0)}},   {"right", {2.4, -0.8, radians(-90.0)}},
    {"rear", {-0.6, 0.3, radians(175.0)}},
};

/// No component for moving targets, no error of time stamps.
DopplerOptions plain_options() {
  DopplerOptions options;
  options.stamp_std_s = 0.0;
  options.moving_weight = 0.0;
  return options;
}

/// A residual in standard deviations.
struct Whitened {
  double residual;
  Eigen::RowVector3d jacobian;
  double cost;
  bool is_static;
};

Whitened residual_of(const Target& target, const Eigen::Vector3d& motion, const Pose2& mount,
                     double dt_s, const DopplerOptions& options, double scale) {
  const Eigen::Vector3d z(1.0, target.cos_bearing, target.sin_bearing);
  const Eigen::Vector3d jacobian = doppler_by_motion(mount) * z;
  const Eigen::Vector3d by_bearing =
      doppler_by_bearing(doppler_by_motion(mount).transpose() * motion);
  const DopplerResidual result =
      doppler_residual(target, jacobian.dot(motion), by_bearing.dot(z), dt_s, options, scale);
  const double sigma_m = std::sqrt(result.variance_m2);
  return {result.error_m / sigma_m, jacobian.transpose() / sigma_m, result.cost(),
          result.is_static};
}

Target target_at(double bearing_rad, double doppler_mps, double bearing_std_rad = 0.0) {
  Target target;
  target.bearing_rad = bearing_rad;
  target.cos_bearing = std::cos(bearing_rad);
  target.sin_bearing = std::sin(bearing_rad);
  target.bearing_std_rad = bearing_std_rad;
  target.doppler_mps = doppler_mps;
  target.doppler_std_mps = 0.2;
  return target;
}

/// Change of range that the residual predicts over kShortDt, from a target without Doppler.
double predicted_m(double bearing_rad, const Eigen::Vector3d& motion, const Pose2& mount) {
  return residual_of(target_at(bearing_rad, 0.0), motion, mount, kShortDt, plain_options(), 1.0)
             .residual *
         0.2 * kShortDt;
}

/// The standard deviation by which the residual is whitened; the error must not be zero.
double deviation_m(const Target& target, const Eigen::Vector3d& motion, const Pose2& mount,
                   const DopplerOptions& options, double scale) {
  const double error_m =
      predicted_m(target.bearing_rad, motion, mount) - target.doppler_mps * kShortDt;
  return error_m / residual_of(target, motion, mount, kShortDt, options, scale).residual;
}

/// Range rate of a standing target by following the radar along the vehicle's path.
double range_rate_mps(double bearing_rad, const Eigen::Vector3d& velocity, const Pose2& mount) {
  const Eigen::Vector2d lever = simulation::as_vector(mount).head<2>();
  const Eigen::Vector2d target =
      lever + Eigen::Rotation2Dd(bearing_rad) * Eigen::Vector2d(25.0, 0.0);
  const auto range_m = [&](double time_s) {
    const Eigen::Rotation2Dd rotation(velocity.z() * time_s);
    return (target - (velocity.head<2>() * time_s + rotation * lever)).norm();
  };
  return (range_m(1e-5) - range_m(-1e-5)) / 2e-5;
}

TEST_CASE("driving forward at a static target ahead is a negative Doppler") {
  const Eigen::Vector3d forward(1.0, 0.0, 0.0);
  CHECK(predicted_m(0.0, forward, {}) == Approx(-1.0));
  CHECK(predicted_m(radians(180.0), forward, {}) == Approx(1.0));
  CHECK(predicted_m(radians(60.0), forward, {}) == Approx(-0.5));
  const auto residual = [&](double doppler_mps) {
    return residual_of(target_at(0.0, doppler_mps), forward, {}, kShortDt, plain_options(), 1.0)
        .residual;
  };
  CHECK(residual(-10.0) == Approx(0.0).margin(1e-12));
  CHECK(residual(10.0) == Approx(-2.0 / (0.2 * kShortDt)));
}

TEST_CASE("the prediction is the range rate of a rigid body, for every mount") {
  Random random(1);
  for (const NamedMount& mount : kNamedMounts) {
    CAPTURE(mount.name);
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector3d velocity{uniform(random, -20.0, 20.0), uniform(random, -2.0, 2.0),
                                     uniform(random, -1.5, 1.5)};
      const double bearing_rad = mount.pose.yaw_rad + uniform(random, -1.0, 1.0);
      CHECK(predicted_m(bearing_rad, velocity * kShortDt, mount.pose) ==
            Approx(kShortDt * range_rate_mps(bearing_rad, velocity, mount.pose)).margin(1e-7));
    }
  }
}

TEST_CASE("the Jacobian is the derivative of the residual with its variance held") {
  Random random(2);
  for (const NamedMount& mount : kNamedMounts) {
    for (const double bearing_std_rad : {0.0, 0.05}) {
      CAPTURE(mount.name, bearing_std_rad);
      const Eigen::Vector3d motion{uniform(random, -2.0, 2.0), uniform(random, -0.2, 0.2),
                                   uniform(random, -0.2, 0.2)};
      const double bearing_rad = mount.pose.yaw_rad + uniform(random, -1.0, 1.0);
      const Target target = target_at(bearing_rad, -3.0, bearing_std_rad);
      const DopplerOptions options;
      const double sigma_m = deviation_m(target, motion, mount.pose, options, 1.0);
      const Eigen::Vector3d expected = numeric::central_differences(
          motion, 1e-4,
          [&](const Eigen::Vector3d& at) { return predicted_m(bearing_rad, at, mount.pose); });
      const auto actual = residual_of(target, motion, mount.pose, kShortDt, options, 1.0);
      CHECK((actual.jacobian.transpose() * sigma_m - expected).norm() < 1e-8);
    }
  }
}

TEST_CASE("each source of error contributes to the variance") {
  const Eigen::Vector3d motion(1.5, 0.1, 0.05);
  const Pose2 mount{2.4, 0.8, 1.0};
  const double bearing_rad = 1.3;
  const double doppler_mps = -7.0;
  DopplerOptions options = plain_options();

  const double doppler_m = 0.2 * kShortDt;
  Target target = target_at(bearing_rad, doppler_mps);
  CHECK(deviation_m(target, motion, mount, options, 1.0) == Approx(doppler_m));
  CHECK(deviation_m(target, motion, mount, options, 6.0) == Approx(6.0 * doppler_m));

  options.stamp_std_s = 0.004;
  const double stamp_m = 0.004 * 7.0;
  CHECK(deviation_m(target, motion, mount, options, 1.0) == Approx(std::hypot(doppler_m, stamp_m)));

  target.bearing_std_rad = 0.03;
  const double slope_m = (predicted_m(bearing_rad + 1e-4, motion, mount) -
                          predicted_m(bearing_rad - 1e-4, motion, mount)) /
                         2e-4;
  const double bearing_m = std::abs(slope_m) * 0.03;
  REQUIRE(bearing_m > 0.01);
  CHECK(deviation_m(target, motion, mount, options, 1.0) ==
        Approx(std::hypot(doppler_m, stamp_m, bearing_m)).epsilon(1e-6));
  // The scale applies to the measured standard deviation only.
  CHECK(deviation_m(target, motion, mount, options, 6.0) ==
        Approx(std::hypot(6.0 * doppler_m, stamp_m, bearing_m)).epsilon(1e-6));
}

TEST_CASE("a moving target is explained by the wide component") {
  const Eigen::Vector3d motion(1.0, 0.0, 0.0);
  DopplerOptions options;
  options.stamp_std_s = 0.0;
  const auto residual = [&](double doppler_mps) {
    return residual_of(target_at(0.0, doppler_mps), motion, {}, kShortDt, options, 1.0);
  };
  CHECK(residual(-10.0).is_static);
  CHECK(residual(-9.5).is_static);
  for (const double mover_mps : {-25.0, 0.0, 8.0}) {
    const Whitened mover = residual(mover_mps);
    CHECK_FALSE(mover.is_static);
    CHECK(mover.residual == Approx((-10.0 - mover_mps) / 100.0));
    CHECK(mover.jacobian.x() == Approx(-1.0 / (100.0 * kShortDt)));
  }
  // A scaled-up static component covers larger errors.
  CHECK(residual_of(target_at(0.0, -8.0), motion, {}, kShortDt, options, 10.0).is_static);
  CHECK_FALSE(residual(-8.0).is_static);
  // The component for moving targets is not scaled.
  const auto scaled = residual_of(target_at(0.0, 40.0), motion, {}, kShortDt, options, 10.0);
  CHECK_FALSE(scaled.is_static);
  CHECK(scaled.residual == Approx(-50.0 / 100.0));
}

TEST_CASE("the cost is the negative logarithm of the larger component") {
  Random random(3);
  int movers = 0;
  for (int i = 0; i < 300; ++i) {
    DopplerOptions options;
    options.moving_weight = uniform(random, 0.01, 0.5);
    options.moving_std_mps = uniform(random, 10.0, 100.0);
    const double bearing_rad = uniform(random, -1.0, 1.0);
    const Target target = target_at(bearing_rad, uniform(random, -12.0, -8.0), 0.02);
    const Eigen::Vector3d motion(1.0, 0.0, 0.01);
    const double error_m =
        predicted_m(target.bearing_rad, motion, {}) - target.doppler_mps * kShortDt;
    const auto density = [&](double weight, double doppler_std_mps) {
      Target component = target;
      component.doppler_std_mps = doppler_std_mps;
      DopplerOptions alone = options;
      alone.moving_weight = 0.0;
      const double sigma_m = deviation_m(component, motion, {}, alone, 1.0);
      return weight / sigma_m * std::exp(-0.5 * error_m * error_m / (sigma_m * sigma_m));
    };
    const double as_static = density(1.0 - options.moving_weight, target.doppler_std_mps);
    const double as_moving = density(options.moving_weight, options.moving_std_mps);
    const auto actual = residual_of(target, motion, {}, kShortDt, options, 1.0);
    CHECK(actual.is_static == (as_static >= as_moving));
    CHECK(actual.cost == Approx(-std::log(std::max(as_static, as_moving))));
    movers += actual.is_static ? 0 : 1;
  }
  CHECK(movers > 50);
  CHECK(movers < 250);
}

TEST_CASE("the cost is continuous at the switch to the moving component") {
  const auto at = [](double speed_mps) {
    return residual_of(target_at(0.0, -10.0), {speed_mps * kShortDt, 0.0, 0.0}, {}, kShortDt, {},
                       1.0);
  };
  double is_static = 10.0;
  double is_moving = 15.0;
  REQUIRE(at(is_static).is_static);
  REQUIRE_FALSE(at(is_moving).is_static);
  while (is_moving - is_static > 1e-9) {
    const double middle = 0.5 * (is_static + is_moving);
    (at(middle).is_static ? is_static : is_moving) = middle;
  }
  CHECK(at(is_static).cost == Approx(at(is_moving).cost).margin(1e-6));
  CHECK(std::abs(at(is_static).residual) > 10.0 * std::abs(at(is_moving).residual));
}

TEST_CASE("with moving weight 0 every target is static") {
  const auto actual =
      residual_of(target_at(0.0, 50.0), {1.0, 0.0, 0.0}, {}, kShortDt, plain_options(), 1.0);
  CHECK(actual.is_static);
  CHECK(actual.residual == Approx(-6.0 / (0.2 * kShortDt)));
}

}  // namespace
}  // namespace cremed
