// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "cremed/estimator/cost/mixture.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using simulation::Detections;
using simulation::Random;
using simulation::uniform;

constexpr double kDamping = 10.0;

/// A scan, its outlier ray, and the mixture of both.
struct Problem {
  Detections detections;
  OutlierRay ray;
  TargetSet targets;
  std::unique_ptr<Mixture> mixture = std::make_unique<Mixture>();

  Problem(Detections content, double ray_weight)
      : detections(std::move(content)), ray(ray_options(ray_weight), {}) {
    targets = simulation::targets(detections, {});
    mixture->assign(targets, ray);
  }

  static OutlierRayOptions ray_options(double weight) {
    OutlierRayOptions options;
    options.weight = weight;
    return options;
  }
};

Detections random_detections(Random& random, std::size_t count) {
  Detections detections;
  for (std::size_t i = 0; i < count; ++i) {
    Detection detection;
    detection.range_m = uniform(random, 2.0, 40.0);
    detection.azimuth_rad = uniform(random, -0.7, 0.7);
    detection.range_std_m = uniform(random, 0.05, 0.5);
    detection.azimuth_std_rad = uniform(random, 0.003, 0.06);
    detection.doppler_std_mps = 0.1;
    detections.push_back(detection);
  }
  return detections;
}

Symmetric2 random_covariance(Random& random) {
  const double range_m = uniform(random, 2.0, 40.0);
  const double bearing_rad = uniform(random, -3.0, 3.0);
  const double range_std_m = uniform(random, 0.05, 0.5);
  return polar_covariance(range_m, bearing_rad, range_std_m, uniform(random, 0.003, 0.06));
}

/// A point near some target (0), between targets (1), or beside the scan (2).
Eigen::Vector2d random_point(Random& random, const TargetSet& targets, int regime) {
  if (regime == 0) {
    const auto last = static_cast<double>(targets.size()) - 0.5;
    const Target& target = targets[static_cast<std::size_t>(uniform(random, 0.0, last))];
    return {target.x_m + uniform(random, -0.3, 0.3), target.y_m + uniform(random, -0.3, 0.3)};
  }
  const double reach_m = regime == 1 ? 40.0 : 400.0;
  return {uniform(random, -reach_m, reach_m), uniform(random, -reach_m, reach_m)};
}

/// The mixture by its definition, in a wider type.
struct Definition {
  long double sum = 0.0L;
  long double best_scale = 0.0L;  // s of the best component
  long double best_q = -1.0L;
  long double best_squared_distance = 0.0L;

  void add(long double weight, const Eigen::Vector2d& error, const Eigen::Matrix2d& covariance) {
    using Matrix = Eigen::Matrix<long double, 2, 2>;
    using Vector = Eigen::Matrix<long double, 2, 1>;
    const Matrix wide = covariance.cast<long double>();
    const Vector e = error.cast<long double>();
    const long double scale = weight / std::sqrt(wide.determinant());
    const long double squared_distance = e.dot(wide.inverse() * e);
    const long double q = scale * std::exp(-0.5L * squared_distance);
    sum += q;
    if (q > best_q) {
      best_q = q;
      best_scale = scale;
      best_squared_distance = squared_distance;
    }
  }
};

Definition define(const Problem& problem, const Eigen::Vector2d& point, const Symmetric2& own) {
  Definition result;
  long double ray_weight = 0.0L;
  for (const RayComponent& component : problem.ray) {
    ray_weight += static_cast<long double>(component.weight);
  }
  const auto count = static_cast<long double>(problem.targets.size());
  const Eigen::Matrix2d own_covariance = numeric::matrix(own);
  for (const Target& target : problem.targets) {
    result.add((1.0L - ray_weight) / count, point - Eigen::Vector2d(target.x_m, target.y_m),
               numeric::matrix(target.covariance_m2) + own_covariance);
  }
  for (const RayComponent& component : problem.ray) {
    result.add(static_cast<long double>(component.weight),
               point - Eigen::Vector2d(component.x_m, component.y_m),
               numeric::matrix(component.covariance_m2) + own_covariance);
  }
  return result;
}

/// Calls `check(problem, point, covariance)` for random mixtures, with and without a ray.
template <typename Check>
void for_random_points(const Check& check) {
  Random random(3);
  for (const double weight : {0.0, 0.2, 0.5, 0.95}) {
    for (const std::size_t count : {1U, 3U, 20U, 120U}) {
      const Problem problem(random_detections(random, count), weight);
      for (int i = 0; i < 60; ++i) {
        const Eigen::Vector2d point = random_point(random, problem.targets, i % 3);
        CAPTURE(weight, count, point.x(), point.y());
        check(problem, point, random_covariance(random));
      }
    }
  }
}

TEST_CASE("the cost is the negative logarithm of the mixture, also where its terms underflow") {
  int underflows = 0;
  int compared = 0;
  for_random_points(
      [&](const Problem& problem, const Eigen::Vector2d& point, const Symmetric2& own) {
        const Definition definition = define(problem, point, own);
        if (definition.sum < 1e-4900L) {
          return;  // the definition itself underflows
        }
        ++compared;
        underflows += definition.sum < 1e-320L ? 1 : 0;
        const double cost = problem.mixture->evaluate(point, own).cost;
        CHECK(cost ==
              Approx(static_cast<double>(-std::log(definition.sum))).epsilon(1e-6).margin(1e-6));
      });
  CHECK(compared > 700);
  CHECK(underflows > 30);
}

TEST_CASE("the residuals are those of the best component and of the rest of the sum") {
  for_random_points(
      [](const Problem& problem, const Eigen::Vector2d& point, const Symmetric2& own) {
        const Definition definition = define(problem, point, own);
        if (definition.sum < 1e-4900L) {
          return;
        }
        const MixtureResidual actual = problem.mixture->evaluate(point, own);
        CHECK(actual.residual.head<2>().squaredNorm() ==
              Approx(static_cast<double>(definition.best_squared_distance)).margin(1e-9));
        const auto damping = static_cast<long double>(kDamping);
        const auto components = static_cast<long double>(problem.mixture->size());
        const long double expected = -std::log(definition.sum) + std::log(definition.best_scale) +
                                     std::log(components + damping);
        CHECK(0.5 * actual.residual.squaredNorm() ==
              Approx(static_cast<double>(expected)).epsilon(1e-6).margin(1e-6));
        const long double rest = std::log(definition.sum / definition.best_q);
        CHECK(0.5 * actual.residual.z() * actual.residual.z() ==
              Approx(static_cast<double>(std::log(components + damping) - rest)).epsilon(1e-5));
      });
}

TEST_CASE("the Jacobian is the derivative of all three residuals") {
  constexpr double kStep = 1e-5;
  int compared = 0;
  for_random_points(
      [&](const Problem& problem, const Eigen::Vector2d& point, const Symmetric2& own) {
        const MixtureResidual actual = problem.mixture->evaluate(point, own);
        bool is_switch_near = false;
        const auto residual = [&](const Eigen::Vector2d& p) -> Eigen::Vector3d {
          const MixtureResidual value = problem.mixture->evaluate(p, own);
          is_switch_near =
              is_switch_near || value.jacobian.topRows<2>() != actual.jacobian.topRows<2>();
          return value.residual;
        };
        const Eigen::Matrix<double, 3, 2> expected =
            numeric::central_differences(point, kStep, residual);
        if (is_switch_near) {
          return;
        }
        ++compared;
        CHECK((actual.jacobian - expected).cwiseAbs().maxCoeff() < 1e-5 * (1.0 + expected.norm()));
      });
  CHECK(compared > 900);
}

TEST_CASE("Gauss-Newton's gradient is the derivative of the cost, across switches as well") {
  for_random_points(
      [](const Problem& problem, const Eigen::Vector2d& point, const Symmetric2& own) {
        const MixtureResidual actual = problem.mixture->evaluate(point, own);
        const Eigen::Vector2d gradient = actual.jacobian.transpose() * actual.residual;
        const Eigen::Vector2d expected = numeric::central_differences(
            point, 1e-5,
            [&](const Eigen::Vector2d& p) { return problem.mixture->evaluate(p, own).cost; });
        CHECK((gradient - expected).norm() < 1e-5 * (1.0 + expected.norm()));
      });
}

TEST_CASE("a point far from all components has a finite cost and a gradient towards them") {
  Random random(4);
  for (const double weight : {0.0, 0.5}) {
    const Problem problem(random_detections(random, 30), weight);
    for (const double distance_m : {1e3, 1e6, 1e9}) {
      CAPTURE(weight, distance_m);
      const Eigen::Vector2d point(distance_m, -0.5 * distance_m);
      const MixtureResidual actual = problem.mixture->evaluate(point, {0.04, 0.01, 0.09});
      CHECK(std::isfinite(actual.cost));
      CHECK(actual.residual.allFinite());
      CHECK(actual.jacobian.allFinite());
      CHECK((actual.jacobian.transpose() * actual.residual).dot(point) > 0.0);
    }
  }
}

TEST_CASE("a single component is a plain least squares problem") {
  Random random(5);
  const Problem problem(random_detections(random, 1), 0.0);
  const Target& target = problem.targets[0];
  const Symmetric2 own = random_covariance(random);
  const Eigen::Vector2d error(0.4, -0.7);
  const MixtureResidual actual =
      problem.mixture->evaluate(Eigen::Vector2d(target.x_m, target.y_m) + error, own);
  const Eigen::Matrix2d covariance = numeric::matrix(target.covariance_m2) + numeric::matrix(own);
  CHECK(problem.mixture->size() == 1);
  CHECK(actual.residual.head<2>().squaredNorm() == Approx(error.dot(covariance.inverse() * error)));
  CHECK(actual.residual.z() == Approx(std::sqrt(2.0 * std::log(11.0))));
  CHECK(actual.jacobian.row(2).norm() < 1e-12);
  CHECK((actual.jacobian.transpose() * actual.jacobian - covariance.inverse()).norm() < 1e-9);
}

TEST_CASE("the order of the targets does not matter") {
  Random random(6);
  Detections detections = random_detections(random, 100);
  const Problem problem(detections, 0.5);
  std::shuffle(detections.begin(), detections.end(), random);
  const Problem shuffled(detections, 0.5);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector2d point = random_point(random, problem.targets, i % 3);
    const Symmetric2 own = random_covariance(random);
    const MixtureResidual a = problem.mixture->evaluate(point, own);
    const MixtureResidual b = shuffled.mixture->evaluate(point, own);
    CHECK(a.cost == Approx(b.cost).epsilon(1e-10));
    CHECK((a.residual - b.residual).norm() < 1e-9 * (1.0 + a.residual.norm()));
    CHECK((a.jacobian - b.jacobian).norm() < 1e-9 * (1.0 + a.jacobian.norm()));
  }
}

TEST_CASE("a ray of small weight explains only points far from all targets") {
  Random random(8);
  const Problem problem(random_detections(random, 20), 1e-9);
  int wrong = 0;
  for (int i = 0; i < 200; ++i) {
    const Target& target = problem.targets[static_cast<std::size_t>(i % 20)];
    const Eigen::Vector2d point(target.x_m + uniform(random, -2.0, 2.0), target.y_m);
    const Symmetric2 own{0.01, 0.0, 0.01};
    const Definition definition = define(problem, point, own);
    const MixtureResidual actual = problem.mixture->evaluate(point, own);
    const double cost = static_cast<double>(-std::log(definition.sum));
    const double distance_error = actual.residual.head<2>().squaredNorm() -
                                  static_cast<double>(definition.best_squared_distance);
    wrong += std::abs(distance_error) > 1e-6 || std::abs(actual.cost - cost) > 1e-6 ? 1 : 0;
  }
  CHECK(wrong == 0);
}

TEST_CASE("the cost is exact for wide, sharp and far components") {
  struct Case {
    const char* name;
    double range_std_m;
    double azimuth_std_rad;
    double own_std_m;
    double offset_m;  // of the point from a target
  };
  const auto c = GENERATE(values<Case>({{"usual", 0.2, 0.02, 0.3, 0.5},
                                        {"sharp", 1e-3, 1e-4, 1e-3, 0.05},
                                        {"sharper", 1e-6, 1e-7, 1e-6, 1e-5},
                                        {"thin", 1e-3, 0.5, 1e-3, 0.3},
                                        {"thinner", 1e-5, 0.5, 1e-5, 1e-3},
                                        {"between", 0.1, 0.01, 0.2, 8.0},
                                        {"wide", 5.0, 0.5, 3.0, 1.0}}));
  Random random(9);
  Detections detections = random_detections(random, 250);
  for (Detection& detection : detections) {
    detection.range_std_m = c.range_std_m * uniform(random, 0.5, 2.0);
    detection.azimuth_std_rad = c.azimuth_std_rad * uniform(random, 0.5, 2.0);
  }
  const Problem problem(detections, 0.2);
  for (int i = 0; i < 100; ++i) {
    const Target& target = problem.targets[static_cast<std::size_t>(i)];
    const Eigen::Vector2d point(target.x_m + c.offset_m, target.y_m);
    const double variance_m2 = c.own_std_m * c.own_std_m;
    const Symmetric2 own{variance_m2, 0.0, 0.5 * variance_m2};
    const Definition definition = define(problem, point, own);
    const MixtureResidual actual = problem.mixture->evaluate(point, own);
    CAPTURE(c.name, i);
    CHECK(actual.residual.head<2>().squaredNorm() ==
          Approx(static_cast<double>(definition.best_squared_distance)).epsilon(1e-6).margin(1e-9));
    CHECK(actual.cost ==
          Approx(static_cast<double>(-std::log(definition.sum))).epsilon(1e-9).margin(1e-9));
  }
}

TEST_CASE("a point or covariance that is NaN has a cost that is NaN") {
  Random random(11);
  const Problem problem(random_detections(random, 60), 0.2);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto cost = [&](double x_m, double y_m, double variance_m2) {
    return problem.mixture->evaluate({x_m, y_m}, {variance_m2, 0.0, 0.1}).cost;
  };
  CHECK_FALSE(std::isfinite(cost(nan, 1.0, 0.1)));
  CHECK_FALSE(std::isfinite(cost(10.0, infinity, 0.1)));
  CHECK_FALSE(std::isfinite(cost(10.0, 1.0, nan)));
  CHECK(std::isfinite(cost(10.0, 1.0, 0.1)));
}

TEST_CASE("assigning replaces the previous mixture") {
  Random random(7);
  const Problem before(random_detections(random, kMaxDetections), 0.5);
  const Problem fresh(random_detections(random, 4), 0.0);
  CHECK(before.mixture->size() == kMaxDetections + before.ray.size());
  before.mixture->evaluate({1.0, 2.0}, {0.1, 0.0, 0.1});
  before.mixture->assign(fresh.targets, fresh.ray);
  CHECK(before.mixture->size() == 4);
  const MixtureResidual a = before.mixture->evaluate({10.0, 2.0}, {0.1, 0.02, 0.1});
  const MixtureResidual b = fresh.mixture->evaluate({10.0, 2.0}, {0.1, 0.02, 0.1});
  CHECK(a.cost == b.cost);
  CHECK(a.residual == b.residual);
  CHECK(a.jacobian == b.jacobian);
}

}  // namespace
}  // namespace cremed
