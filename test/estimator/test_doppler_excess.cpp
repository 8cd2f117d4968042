// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <random>

#include <catch2/catch.hpp>

#include "cremed/estimator/fusion/measurement/doppler_excess.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using simulation::Random;

constexpr double kExcessPeriodS = 0.075;
const Eigen::Vector2d kCreepingMps(0.5, 0.0);

/// What a radar with this noise of Doppler reports. `share` of what it sees moves ahead with
/// `traffic_mps`. The velocity that the fit finds is then that much lower.
class SeenTraffic {
 public:
  SeenTraffic(double noise_mps, std::uint64_t seed) : noise_mps_(noise_mps), random_(seed) {}

  double largest_excess(double share, double traffic_mps, double time_s) {
    double largest = 0.0;
    for (double t_s = 0.0; t_s < time_s; t_s += kExcessPeriodS) {
      last_ = see(share, traffic_mps);
      largest = std::max(largest, last_);
    }
    return largest;
  }
  void forget() { excess_.forget(); }
  [[nodiscard]] double last() const { return last_; }

 private:
  double see(double share, double traffic_mps) {
    const simulation::Noise noise{0.1, 0.001, noise_mps_};
    simulation::Detections detections;
    const auto points = simulation::scatter(random_, 40, 3.0, 50.0, 1.0, 0.5);
    for (const Eigen::Vector2d& point : points) {
      const bool moves = simulation::uniform(random_, 0.0, 1.0) < share;
      const Eigen::Vector3d velocity(kCreepingMps.x() - (moves ? traffic_mps : 0.0), 0.0, 0.0);
      detections.push_back(simulation::observe(point, velocity, Pose2(), noise));
    }
    simulation::perturb(detections, random_);
    const Eigen::Vector2d fitted = kCreepingMps - Eigen::Vector2d(share * traffic_mps, 0.0);
    return excess_.add(simulation::targets(detections, Pose2()), fitted, kExcessPeriodS);
  }

  double noise_mps_;
  Random random_;
  DopplerExcess excess_;
  double last_ = 0.0;
};

TEST_CASE("static targets have no excess, whatever the radar's noise is") {
  for (const double noise_mps : {0.03, 0.13, 0.27}) {
    CAPTURE(noise_mps);
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      SeenTraffic seen(noise_mps, seed);
      CHECK(seen.largest_excess(0.0, 0.0, 30.0) < 0.01);
    }
  }
}

TEST_CASE("slow cars that pass as static are an excess while they are there") {
  SeenTraffic seen(0.1, 7);
  REQUIRE(seen.largest_excess(0.0, 0.0, 5.0) == 0.0);
  seen.largest_excess(0.75, 0.5, 20.0);
  // q (1 - q) V^2 is 0.047, seen along the road only.
  CHECK(seen.last() > 0.01);
  CHECK(seen.last() < 0.05);
  seen.largest_excess(0.0, 0.0, 3.0);
  CHECK(seen.last() == 0.0);
}

TEST_CASE("after a gap there is no excess, and a scan of few targets tells nothing") {
  SeenTraffic seen(0.1, 7);
  seen.largest_excess(0.0, 0.0, 5.0);
  seen.largest_excess(0.75, 0.5, 5.0);
  REQUIRE(seen.last() > 0.01);
  seen.forget();
  seen.largest_excess(0.0, 0.0, 0.5 * kExcessPeriodS);
  CHECK(seen.last() == 0.0);
  DopplerExcess excess;
  CHECK(excess.add(TargetSet(), kCreepingMps, kExcessPeriodS) == 0.0);
}

TEST_CASE("a jam at the start is its noise until it is gone") {
  SeenTraffic seen(0.1, 7);
  CHECK(seen.largest_excess(0.75, 0.5, 10.0) < 0.01);
  seen.largest_excess(0.0, 0.0, 10.0);
  seen.largest_excess(0.75, 0.5, 5.0);
  CHECK(seen.last() > 0.01);
}

}  // namespace
}  // namespace cremed
