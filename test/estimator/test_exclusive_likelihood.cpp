// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "cremed/estimator/cost/exclusive_likelihood.hpp"
#include "cremed/estimator/registration/registration.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using numeric::radians;
using simulation::Detections;
using simulation::kDt;
using simulation::kStill;
using simulation::Points;
using simulation::Random;
using simulation::uniform;

TargetSet view_of(const Points& points, const Eigen::Vector3d& motion, double std_m) {
  return simulation::targets(simulation::isotropic(simulation::see(points, motion), std_m), {});
}

OutlierRay ray_of(double weight) {
  OutlierRayOptions options;
  options.weight = weight;
  return {options, Pose2{}};
}

/// A likelihood of two scans.
class Scene {
 public:
  Scene(TargetSet previous, TargetSet current, const OutlierRay& ray)
      : previous_(std::move(previous)), current_(std::move(current)) {
    likelihood_->assign(previous_, current_, ray);
  }

  /// With converged probabilities.
  NormalEquations linearise(const Eigen::Vector3d& motion) {
    REQUIRE(likelihood_->list_pairs(previous_, current_, motion));
    NormalEquations equations;
    for (int i = 0; i < 20; ++i) {
      equations = likelihood_->linearise(previous_, current_, motion);
    }
    return equations;
  }
  ExclusiveLikelihood& operator*() { return *likelihood_; }

 private:
  TargetSet previous_;
  TargetSet current_;
  std::unique_ptr<ExclusiveLikelihood> likelihood_ = std::make_unique<ExclusiveLikelihood>();
};

/// Landmarks, every other of them with two more beside it.
Points clustered(Random& random) {
  std::normal_distribution<double> normal(0.0, 0.1);
  Points points = simulation::scatter(random, 8, 5.0, 30.0, radians(50.0), 4.0);
  for (std::size_t i = 0; i < 8; i += 2) {
    for (int extra = 0; extra < 2; ++extra) {
      points.emplace_back(points[i] + Eigen::Vector2d(normal(random), normal(random)));
    }
  }
  return points;
}

TEST_CASE("the gradient is the derivative of the cost where covariances do not turn") {
  Random random(1);
  for (const double weight : {0.0, 0.2, 0.5}) {
    for (int run = 0; run < 20; ++run) {
      const Points points = clustered(random);
      const Eigen::Vector3d motion(0.3, 0.1, 0.05);
      Scene scene(view_of(points, kStill, 0.2), view_of(points, motion, 0.2), ray_of(weight));
      const Eigen::Vector3d at =
          motion + Eigen::Vector3d(uniform(random, -0.2, 0.2), uniform(random, -0.2, 0.2),
                                   uniform(random, -0.01, 0.01));
      const NormalEquations equations = scene.linearise(at);
      const Eigen::Vector3d expected = numeric::central_differences(
          at, 1e-5, [&](const Eigen::Vector3d& m) { return scene.linearise(m).cost; });
      CAPTURE(weight, run, equations.gradient.transpose(), expected.transpose());
      // Relative to the change for one sigma of each state.
      const Eigen::Vector3d sigma = equations.information.diagonal().cwiseSqrt().cwiseInverse();
      const Eigen::Vector3d error = (equations.gradient - expected).cwiseProduct(sigma);
      CHECK(error.norm() < 0.01 * (1.0 + expected.cwiseProduct(sigma).norm()));
    }
  }
}

TEST_CASE("complete less missing information is the curvature of the cost") {
  Random random(2);
  double total_missing = 0.0;
  for (const double weight : {0.0, 0.2, 0.5}) {
    for (int run = 0; run < 20; ++run) {
      const Points points = clustered(random);
      const Points some(points.begin(), points.end() - 3);  // two clusters are partly hidden
      const Eigen::Vector3d motion(0.3, 0.1, 0.05);
      Scene scene(view_of(points, kStill, 0.2), view_of(some, motion, 0.2), ray_of(weight));
      const Eigen::Matrix3d slope = numeric::central_differences(
          motion, 1e-5, [&](const Eigen::Vector3d& m) { return scene.linearise(m).gradient; });
      const Eigen::Matrix3d complete = scene.linearise(motion).information;
      const Eigen::Vector3d sigma = complete.diagonal().cwiseSqrt().cwiseInverse();
      const Eigen::Matrix3d missing = (*scene).missing_information(sigma);
      const auto in_sigmas = [&](const Eigen::Matrix3d& m) -> Eigen::Matrix3d {
        return sigma.asDiagonal() * m * sigma.asDiagonal();
      };
      CAPTURE(weight, run, in_sigmas(missing), in_sigmas(complete - slope));
      CHECK(in_sigmas(complete - missing - slope).cwiseAbs().maxCoeff() < 0.01);
      total_missing += in_sigmas(missing).trace() / 60.0;
    }
  }
  CHECK(total_missing > 0.003);  // the assignment in a cluster is unknown
}

/// Three targets about 0.1 m apart, seen with 0.2 m of noise.
struct Cluster {
  explicit Cluster(Random& random) {
    std::normal_distribution<double> apart(0.0, 0.1);
    std::normal_distribution<double> noise(0.0, kStdM);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector2d point(10.0 + apart(random), 3.0 + apart(random));
      previous.emplace_back(point + Eigen::Vector2d(noise(random), noise(random)));
      current.emplace_back(point + Eigen::Vector2d(noise(random), noise(random)));
    }
  }
  static Eigen::Vector2d centre(const Points& p) { return (p[0] + p[1] + p[2]) / 3.0; }

  static constexpr double kStdM = 0.2;
  Points previous;
  Points current;
};

TEST_CASE("a cluster's motion is that of its centre, as precise as of three targets") {
  constexpr double kVarianceM2 = 2.0 * Cluster::kStdM * Cluster::kStdM / 3.0;  // of the centre
  RegistrationOptions options = simulation::paper_options();
  options.doppler.enabled = false;
  options.outlier_ray.weight = 0.0;
  Random random(3);
  double squared_step_m2 = 0.0;
  double squared_mixture_step_m2 = 0.0;
  constexpr int kRuns = 200;
  for (int run = 0; run < kRuns; ++run) {
    const Cluster cluster(random);
    const TargetSet previous = view_of(cluster.previous, kStill, Cluster::kStdM);
    const TargetSet current = view_of(cluster.current, kStill, Cluster::kStdM);
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    centre.head<2>() = Cluster::centre(cluster.previous) - Cluster::centre(cluster.current);
    Scene scene(previous, current, ray_of(0.0));
    const NormalEquations equations = scene.linearise(centre);
    const Eigen::Vector3d sigma = equations.information.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::Matrix2d information =
        (equations.information - (*scene).missing_information(sigma)).topLeftCorner<2, 2>();
    // All assignments have the same mean error and so the same translation.
    CHECK((information * kVarianceM2 - Eigen::Matrix2d::Identity()).norm() < 0.05);
    squared_step_m2 +=
        (kVarianceM2 * equations.gradient.head<2>()).squaredNorm() / (2.0 * kRuns * kVarianceM2);

    const NormalEquations nearest =
        simulation::mixture_cost(options, {}, previous, current, kDt)->linearise({centre});
    squared_mixture_step_m2 +=
        (kVarianceM2 * nearest.gradient.head<2>()).squaredNorm() / (2.0 * kRuns * kVarianceM2);
  }
  // In variances of the estimate: the mixture is biased towards nearest neighbours.
  CHECK(squared_step_m2 < 0.001);
  CHECK(squared_mixture_step_m2 > 0.02);
}

TEST_CASE("a pair's ratio follows from the density and share of new targets") {
  struct Row {
    double weight;
    std::size_t previous, current;  // targets of each scan, far apart, the first at the same place
  };
  const std::vector<Row> rows = {{0.2, 4, 4},  {0.5, 4, 4},    {0.9, 6, 3},
                                 {0.2, 2, 20}, {0.01, 20, 20}, {0.99, 20, 2}};
  constexpr double kStdM = 0.1;
  const Eigen::Vector2d place(12.0, 2.0);
  for (const Row& row : rows) {
    Points previous(row.previous, Eigen::Vector2d(100.0, 0.0));
    Points current(row.current, Eigen::Vector2d(-100.0, 0.0));
    previous[0] = place;
    current[0] = place;
    const OutlierRay ray = ray_of(row.weight);
    Scene scene(view_of(previous, kStill, kStdM), view_of(current, kStill, kStdM), ray);
    const NormalEquations equations = scene.linearise(kStill);

    const auto density = [&](const Eigen::Vector2d& error, const Eigen::Matrix2d& covariance) {
      return std::exp(-0.5 * error.dot(covariance.inverse() * error)) /
             (2.0 * std::numbers::pi * std::sqrt(covariance.determinant()));
    };
    const Eigen::Matrix2d own = kStdM * kStdM * Eigen::Matrix2d::Identity();
    double new_targets = 0.0;
    for (const RayComponent& component : ray) {
      new_targets +=
          component.weight * density(place - Eigen::Vector2d(component.x_m, component.y_m),
                                     numeric::matrix(component.covariance_m2) + own);
    }
    const auto n = static_cast<double>(row.current);
    const double again = std::min((1.0 - row.weight) * n / static_cast<double>(row.previous), 0.95);
    const double ratio = again / (1.0 - again) * density({0.0, 0.0}, 2.0 * own) / (n * new_targets);
    CAPTURE(row.weight, row.previous, row.current);
    CHECK((*scene).matched() == Approx(ratio / (1.0 + ratio)).epsilon(1e-6));
    CHECK(equations.cost == Approx(-std::log1p(ratio)).epsilon(1e-6));
  }
}

TEST_CASE("a target far from all others is new and adds no information") {
  const Points near = {{10.0, 3.0}, {30.0, -8.0}, {18.0, 15.0}};
  Points more = near;
  more.emplace_back(25.0, 4.0);
  const OutlierRay ray = ray_of(0.2);
  Scene alone(view_of(near, kStill, 0.1), view_of(near, kStill, 0.1), ray);
  const NormalEquations expected = alone.linearise(kStill);
  const double matched = (*alone).matched();
  CHECK(matched > 2.9);
  Scene scene(view_of(near, kStill, 0.1), view_of(more, kStill, 0.1), ray);
  const NormalEquations actual = scene.linearise(kStill);
  CHECK((*scene).matched() == Approx(matched).epsilon(0.02));
  CHECK((actual.information - expected.information).norm() < 0.02 * expected.information.norm());
  Scene strange(view_of({{10.0, 3.0}}, kStill, 0.1), view_of({{10.0, 5.0}}, kStill, 0.1), ray);
  CHECK(strange.linearise(kStill).information.isZero(0.0));
  CHECK((*strange).matched() == 0.0);
}

TEST_CASE("with scans of equal size the likelihood is symmetric") {
  Random random(5);
  for (int run = 0; run < 20; ++run) {
    const Points points = clustered(random);
    Points noisy = points;
    for (Eigen::Vector2d& point : noisy) {
      point += Eigen::Vector2d(uniform(random, -0.2, 0.2), uniform(random, -0.2, 0.2));
    }
    // Without a ray and without a turn the density of new targets is uniform.
    const TargetSet a = view_of(points, kStill, 0.2);
    const TargetSet b = view_of(noisy, kStill, 0.2);
    const Eigen::Vector3d motion(0.1, -0.05, 0.0);
    Scene there(a, b, ray_of(0.0));
    Scene back(b, a, ray_of(0.0));
    const NormalEquations forwards = there.linearise(motion);
    const NormalEquations backwards = back.linearise(-motion);
    CHECK(forwards.cost == Approx(backwards.cost).epsilon(1e-6));
    CHECK((*there).matched() == Approx((*back).matched()).epsilon(1e-3));
    const Eigen::Vector2d sum = forwards.gradient.head<2>() + backwards.gradient.head<2>();
    CHECK(sum.norm() < 0.01 * std::sqrt(forwards.information(0, 0)));
  }
}

TEST_CASE("more possible pairs than the capacity are ambiguous") {
  const Points crowd(kMaxDetections, Eigen::Vector2d(10.0, 1.0));
  const TargetSet targets = view_of(crowd, kStill, 0.1);
  const auto likelihood = std::make_unique<ExclusiveLikelihood>();
  likelihood->assign(targets, targets, ray_of(0.2));
  CHECK_FALSE(likelihood->list_pairs(targets, targets, kStill));
  const NormalEquations equations = likelihood->linearise(targets, targets, kStill);
  CHECK(std::isfinite(equations.cost));
  CHECK(equations.information.allFinite());

  for (const int degrees_of_freedom : {2, 3}) {
    RegistrationOptions options = simulation::paper_options();
    options.degrees_of_freedom = degrees_of_freedom;
    Registration registration(options, {});
    registration.set_previous(targets);
    CHECK(registration.solve(targets, kDt).status == RegistrationStatus::ambiguous);
  }
}

TEST_CASE("pairs are listed up to the capacity") {
  // 32 places of eight: 64 pairs each.
  Points places;
  for (int i = 0; i < 256; ++i) {
    places.emplace_back(10.0 + 5.0 * static_cast<double>(i / 8), 0.0);
  }
  const TargetSet targets = view_of(places, kStill, 0.1);
  const auto likelihood = std::make_unique<ExclusiveLikelihood>();
  likelihood->assign(targets, targets, ray_of(0.2));
  CHECK(likelihood->list_pairs(targets, targets, kStill));
  likelihood->linearise(targets, targets, kStill);
  CHECK(likelihood->matched() == Approx(256.0).epsilon(0.05));
  // 256 x 256 distances, six ray components each, 32 x 64 pairs, once more for every round.
  constexpr int kPairs = 32 * 64;
  CHECK(likelihood->evaluations() <= 65536 + 256 * 6 + (5 + Association::kMaxRounds) * kPairs);
}

}  // namespace
}  // namespace cremed
