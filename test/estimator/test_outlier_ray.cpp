// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "cremed/estimator/cost/outlier_ray.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using numeric::kInfinity;
using numeric::kNan;

OutlierRayOptions make_options(double min_range_m, double max_range_m) {
  OutlierRayOptions options;
  options.min_range_m = min_range_m;
  options.max_range_m = max_range_m;
  return options;
}

double total_weight(const OutlierRay& ray) {
  double sum = 0.0;
  for (const RayComponent& component : ray) {
    sum += component.weight;
  }
  return sum;
}

TEST_CASE("the number of components follows the formula") {
  struct Row {
    OutlierRayOptions options;
    std::size_t count;
  };
  const std::vector<Row> rows = {
      {make_options(0.5, 50.0), 6},      // 1 + ceil(log(17.65) / log(1.8)) = 1 + ceil(4.88)
      {make_options(0.5, 200.0), 9},     // 1 + ceil(7.24)
      {make_options(1.0, 10.0), 2},      // 1 + ceil(0.97)
      {make_options(1.0, 11.0), 3},      // 1 + ceil(1.13)
      {make_options(0.01, 1000.0), 18},  // 1 + ceil(16.6): the widest of a configuration
      {make_options(1.0, 2.9), 1},       // the first one covers it
      {make_options(50.0, 0.5), 1},
  };
  for (const Row& row : rows) {
    CAPTURE(row.options.min_range_m, row.options.max_range_m);
    CHECK(ray_component_count(row.options) == row.count);
    CHECK(OutlierRay(row.options, {}).size() == row.count);
  }
}

TEST_CASE("the components cover the ray from r_min to r_max, and none is redundant") {
  for (const auto& options :
       {make_options(0.5, 50.0), make_options(1.0, 100.0), make_options(0.2, 250.0)}) {
    const OutlierRay ray(options, {});
    const RayComponent& last = *(ray.end() - 1);
    CHECK(ray.begin()->x_m * (1.0 - kRayRatio) == Approx(options.min_range_m));
    CHECK(last.x_m * (1.0 + kRayRatio) >= options.max_range_m);
    CHECK((ray.end() - 2)->x_m * (1.0 + kRayRatio) < options.max_range_m);
  }
}

TEST_CASE("ranges grow by b, and the deviations with them") {
  const OutlierRayOptions options;
  const OutlierRay ray(options, {});
  double range_m = 0.5 / 0.3;
  for (const RayComponent& component : ray) {
    CAPTURE(range_m);
    CHECK(component.x_m == Approx(range_m));
    CHECK(component.y_m == Approx(0.0).margin(1e-12));
    // Twice a rho along the ray, three times half the field of view across it.
    CHECK(std::sqrt(component.covariance_m2.xx) == Approx(2.0 * 0.7 * range_m));
    CHECK(std::sqrt(component.covariance_m2.yy) == Approx(range_m * 3.0 * numeric::radians(40.0)));
    CHECK(component.covariance_m2.xy == Approx(0.0).margin(1e-9));
    range_m *= 1.8;
  }
}

TEST_CASE("the weights add up to w_o, in proportion to the root of the determinant") {
  for (const double weight : {1e-6, 0.2, 0.5, 0.999}) {
    OutlierRayOptions options;
    options.weight = weight;
    const OutlierRay ray(options, {2.0, 1.0, 0.7});
    CHECK(total_weight(ray) == Approx(weight));
    const auto density = [](const RayComponent& component) {
      return component.weight / std::sqrt(numeric::matrix(component.covariance_m2).determinant());
    };
    for (const RayComponent& component : ray) {
      CHECK(density(component) == Approx(density(*ray.begin())));
    }
  }
}

TEST_CASE("the ray turns and moves with the mount") {
  const OutlierRay straight(OutlierRayOptions{}, {});
  simulation::Random random(1);
  for (int i = 0; i < 20; ++i) {
    const Pose2 mount{simulation::uniform(random, -2.0, 4.0),
                      simulation::uniform(random, -1.0, 1.0),
                      simulation::uniform(random, -3.1, 3.1)};
    const OutlierRay ray(OutlierRayOptions{}, mount);
    const Eigen::Matrix2d rotation = Eigen::Rotation2Dd(mount.yaw_rad).toRotationMatrix();
    REQUIRE(ray.size() == straight.size());
    for (std::size_t k = 0; k < ray.size(); ++k) {
      const RayComponent& actual = ray.begin()[k];
      const RayComponent& local = straight.begin()[k];
      const Eigen::Vector2d centre =
          simulation::as_vector(mount).head<2>() + rotation * Eigen::Vector2d(local.x_m, local.y_m);
      const Eigen::Matrix2d covariance =
          rotation * numeric::matrix(local.covariance_m2) * rotation.transpose();
      CHECK((Eigen::Vector2d(actual.x_m, actual.y_m) - centre).norm() < 1e-9);
      CHECK((numeric::matrix(actual.covariance_m2) - covariance).norm() <
            1e-12 * covariance.norm());
      CHECK(actual.weight == Approx(local.weight));
    }
  }
}

TEST_CASE("without weight there is no ray") {
  for (const double weight : {0.0, -0.5}) {
    OutlierRayOptions options;
    options.weight = weight;
    const OutlierRay ray(options, {});
    CHECK(ray.size() == 0);
    CHECK(ray.begin() == ray.end());
  }
}

TEST_CASE("with extreme options the ray stays finite and within the capacity") {
  for (const auto& options :
       {make_options(1e-9, 50.0), make_options(1e-9, 1e9), make_options(0.5, 1e9)}) {
    const OutlierRay ray(options, {});
    CAPTURE(options.min_range_m, options.max_range_m);
    CHECK(ray.size() == kMaxRayComponents);
    CHECK(total_weight(ray) == Approx(options.weight));
    for (const RayComponent& component : ray) {
      CHECK(std::isfinite(component.x_m));
      CHECK(numeric::matrix(component.covariance_m2).determinant() > 0.0);
    }
  }
}

TEST_CASE("invalid options give a valid number of components") {
  for (const auto& options :
       {make_options(0.0, 50.0), make_options(0.5, kInfinity), make_options(kNan, 50.0),
        make_options(0.5, kNan), make_options(-1.0, 50.0)}) {
    CAPTURE(options.min_range_m, options.max_range_m);
    const std::size_t count = ray_component_count(options);
    CHECK(count >= 1);
    CHECK(count <= kMaxRayComponents);
  }
}

}  // namespace
}  // namespace cremed
