// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause

// The requirements of Gauss-Newton on a cost: see RegistrationCost.

#include <memory>

#include <catch2/catch.hpp>

#include "cremed/estimator/cost/exclusive_cost.hpp"
#include "cremed/estimator/registration/gauss_newton.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using numeric::radians;
using simulation::kDt;
using simulation::Random;
using simulation::uniform;

static_assert(RegistrationCost<MixtureCost>);
static_assert(RegistrationCost<ExclusiveCost>);

const Eigen::Vector3d kMotion(0.5, 0.0, 0.03);

/// Two noisy scans, of which every target has neighbours within its noise; a fifth of them moves.
struct DenseScans {
  explicit DenseScans(std::uint64_t seed) {
    Random random(seed);
    const auto points = simulation::scatter(random, 40, 5.0, 30.0, radians(45.0), 0.5);
    const auto see = [&](const Eigen::Vector3d& motion) {
      auto detections =
          simulation::observe_all(points, motion, kDt, {}, simulation::Noise{0.2, 0.02, 0.1});
      simulation::perturb(detections, random);
      for (std::size_t i = 0; i < detections.size(); i += 5) {
        detections[i].doppler_mps += uniform(random, -3.0, 3.0);
      }
      return simulation::targets(detections, {});
    };
    previous = see(Eigen::Vector3d::Zero());
    current = see(kMotion);
  }

  [[nodiscard]] std::unique_ptr<ExclusiveCost> exclusive(const DopplerOptions& doppler = {}) const {
    auto cost = std::make_unique<ExclusiveCost>(2, doppler, SharedErrorOptions(), Pose2());
    cost->set_scans(previous, current, kDt, OutlierRay(OutlierRayOptions(), {}));
    cost->start();
    cost->settle();
    return cost;
  }

  TargetSet previous;
  TargetSet current;
};

Unknowns random_unknowns(Random& random) {
  Unknowns at{kMotion};
  at.motion += Eigen::Vector3d(uniform(random, -0.2, 0.2), 0.0, uniform(random, -0.02, 0.02));
  at.shared << uniform(random, -0.03, 0.03), uniform(random, -0.02, 0.02),
      uniform(random, -4.0, 4.0), 0.0, uniform(random, -0.5, 0.5);
  return at;
}

bool is_unchanged(const NormalEquations& a, const NormalEquations& b) {
  return a.information == b.information && a.gradient == b.gradient && a.cost == b.cost &&
         a.shared == b.shared;
}

TEST_CASE("the mixture's equations depend on their argument alone") {
  Random random(1);
  const DenseScans scene(2);
  const auto cost =
      simulation::mixture_cost(simulation::paper_options(), {}, scene.previous, scene.current, kDt);
  const Unknowns at = random_unknowns(random);
  const NormalEquations first = cost->linearise(at);
  for (int i = 0; i < 10; ++i) {
    cost->linearise(random_unknowns(random));
    CHECK(is_unchanged(cost->linearise(at), first));
  }
}

TEST_CASE("the exclusive likelihood's equations depend on their argument alone, if settled") {
  Random random(3);
  const DenseScans scene(4);
  const Unknowns at = random_unknowns(random);
  const auto fresh = scene.exclusive();
  const NormalEquations first = fresh->linearise(at);
  REQUIRE(fresh->is_settled());
  const Eigen::Vector3d sigma = first.information.diagonal().cwiseSqrt().cwiseInverse();
  for (int i = 0; i < 10; ++i) {
    const auto used = scene.exclusive();
    for (int k = 0; k < 5; ++k) {
      used->linearise(random_unknowns(random));
    }
    const NormalEquations equations = used->linearise(at);
    const Eigen::Vector3d difference = (equations.gradient - first.gradient).cwiseProduct(sigma);
    CAPTURE(difference.transpose(), equations.cost - first.cost);
    CHECK(difference.cwiseAbs().maxCoeff() < 0.02);
    CHECK(equations.cost == Approx(first.cost).margin(0.01));
    // Doppler has no warm start.
    CHECK(equations.shared == first.shared);
  }
}

TEST_CASE("the returned shared errors are only the next point of linearisation") {
  const DenseScans scene(5);
  DopplerOptions no_movers;
  no_movers.moving_weight = 0.0;
  const auto cost = scene.exclusive(no_movers);
  const NormalEquations first = cost->linearise({kMotion});
  CHECK(first.shared.norm() > 0.0);
  const NormalEquations again = cost->linearise({kMotion, first.shared});
  // They are the minimum there; the motion's equations do not change, because e is linear in them.
  CHECK((again.shared - first.shared).norm() < 1e-9);
  CHECK((again.gradient - first.gradient).norm() < 1e-6 * first.information.norm());
}

TEST_CASE("by positions a step never raises the cost of the exclusive likelihood") {
  DopplerOptions no_doppler;
  no_doppler.enabled = false;
  Random random(6);
  for (std::uint64_t seed = 10; seed < 40; ++seed) {
    const DenseScans scene(seed);
    const auto cost = scene.exclusive(no_doppler);
    Unknowns at{random_unknowns(random).motion};
    NormalEquations equations = cost->linearise(at);
    for (int i = 0; i < 15; ++i) {
      const auto inverse = invert_information(equations.information, 2);
      REQUIRE(inverse);
      at = {at.motion - *inverse * equations.gradient, equations.shared};
      const NormalEquations next = cost->linearise(at);
      CAPTURE(seed, i, next.cost - equations.cost);
      CHECK(next.cost <= equations.cost + 0.01);  // tolerance of the association
      equations = next;
    }
  }
}

TEST_CASE("a step that raises the cost is halved until it does not") {
  const DenseScans scene(7);
  const auto cost =
      simulation::mixture_cost(simulation::paper_options(), {}, scene.previous, scene.current, kDt);
  Descent descent{{kMotion}, cost->linearise({kMotion})};
  const double before = descent.equations.cost;
  const auto inverse = invert_information(descent.equations.information, 2);
  REQUIRE(inverse);
  const Eigen::Vector3d step = -*inverse * descent.equations.gradient;
  const Eigen::Vector3d far = 40.0 * step;
  REQUIRE(cost->linearise({kMotion + far}).cost > before);
  const StoppingRule rule{2, 1e-5, 100, 100'000'000};
  REQUIRE(take_step(*cost, far, rule, descent));
  CHECK(descent.equations.cost <= before);
  CHECK(descent.iterations == 1);
  const double share = (descent.at.motion - kMotion).norm() / far.norm();
  CHECK(share < 0.51);
  CHECK(share > 1e-4);
  // In the direction of the gradient no step is taken.
  Descent uphill{{kMotion}, cost->linearise({kMotion})};
  CHECK_FALSE(take_step(*cost, -far, rule, uphill));
  CHECK(uphill.at.motion == kMotion);
}

}  // namespace
}  // namespace cremed
