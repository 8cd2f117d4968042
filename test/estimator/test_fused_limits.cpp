// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause

// Whatever comes in, a fused estimate is finite and its covariance positive definite.

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include "estimator/fused_estimator.hpp"
#include "test/estimator/drawn_vehicle.hpp"

namespace cremed {
namespace {

using simulation::drawn_options;
using simulation::drawn_radars;
using simulation::DrawnMotion;
using simulation::DrawnRadar;
using simulation::DrawnVehicle;
using simulation::kDrawnStartUs;

/// An estimate, or NaN all over.
bool is_sound(const EgoMotion& motion) {
  if (!motion.has_estimate()) {
    return motion.motion.array().isNaN().all() && motion.covariance.array().isNaN().all();
  }
  const Eigen::Matrix3d& p = motion.covariance;
  return motion.motion.allFinite() && p.allFinite() && p == p.transpose() &&
         p.llt().info() == Eigen::Success && motion.utime_us > motion.utime_start_us;
}

EgoMotion estimate(std::int64_t start_us, std::int64_t end_us) {
  EgoMotion motion;
  motion.utime_start_us = start_us;
  motion.utime_us = end_us;
  motion.status = MotionStatus::ok;
  motion.motion << 1.0, 0.0, 0.01;
  motion.covariance = Eigen::Vector3d(1e-4, 0.0, 1e-5).asDiagonal();
  motion.information = Eigen::Vector3d(1e4, 1e3, 1e5).asDiagonal();
  motion.targets = 30;
  return motion;
}

TEST_CASE("fused: after forget() the next motion begins anew") {
  const EgoMotionOptions options = drawn_options(2);
  DrawnVehicle vehicle(simulation::in_bends, drawn_radars(2), options, 2);
  FusedEstimator estimator({}, options, 2);
  std::vector<MotionStatus> statuses;
  bool has_forgotten = false;
  std::int64_t forgot_us = 0;
  while (vehicle.time_s() < 10.0) {
    const DrawnMotion drawn = vehicle.next();
    if (vehicle.time_s() > 5.0 && !has_forgotten) {
      has_forgotten = true;
      forgot_us = drawn.motion.utime_us;
      estimator.forget();
    }
    const auto fused = estimator.update(drawn.radar, drawn.motion);
    if (fused && has_forgotten) {
      CHECK(fused->utime_start_us >= forgot_us);
      statuses.push_back(fused->status);
    }
  }
  REQUIRE(statuses.size() > 50);
  CHECK(statuses[0] == MotionStatus::no_reference);
  CHECK(statuses[2] == MotionStatus::ok);
  CHECK(statuses.back() == MotionStatus::ok);
}

TEST_CASE("fused: as many radars as there may be") {
  const EgoMotionOptions options = drawn_options(3);
  std::vector<DrawnRadar> radars;
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(kMaxFusedRadars); ++i) {
    radars.push_back({60'000 + 3'000 * i, 4'000 * i, {0.01, 0.02, 0.004}});
  }
  DrawnVehicle vehicle(simulation::in_bends, radars, options, 2);
  FusedEstimator estimator({}, options, radars.size());
  std::size_t estimates = 0;
  while (vehicle.time_s() < 10.0) {
    const DrawnMotion drawn = vehicle.next();
    const auto fused = estimator.update(drawn.radar, drawn.motion);
    CHECK((!fused || is_sound(*fused)));
    estimates += fused && fused->has_estimate() ? 1 : 0;
  }
  CHECK(estimates > 160);
  for (std::size_t radar = 0; radar < radars.size(); ++radar) {
    CHECK(estimator.agreement(radar).used > 80);
  }
}

TEST_CASE("fused: a leader that is long silent does not make others' motions pile up") {
  EgoMotionOptions options = drawn_options(2);
  FusedEstimator estimator({}, options, 2);
  estimator.update(0, estimate(kDrawnStartUs, kDrawnStartUs));
  for (int i = 0; i < 500; ++i) {  // Far more than there is room for, within a quarter second.
    estimator.update(1, estimate(kDrawnStartUs + 100 * i, kDrawnStartUs + 100 * i + 70'000));
  }
  const auto fused = estimator.update(0, estimate(kDrawnStartUs + 50'000, kDrawnStartUs + 120'000));
  REQUIRE(fused);
  CHECK(is_sound(*fused));
  CHECK(fused->has_estimate());
}

TEST_CASE("fused: absurd stamps and numbers do no harm, and do not last") {
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min();
  std::vector<EgoMotion> absurd = {estimate(kMin, kMax),
                                   estimate(kMax - 1, kMax),
                                   estimate(kMin, kMin + 1),
                                   estimate(0, 0),
                                   estimate(kDrawnStartUs + 9'000'000, kDrawnStartUs),
                                   estimate(kDrawnStartUs, kDrawnStartUs + 1)};
  for (const double number : {0.0, 1e-300, 1e-30, 1e30, 1e300}) {
    EgoMotion motion = estimate(kDrawnStartUs + 5'000'000, kDrawnStartUs + 5'075'000);
    motion.motion *= number;
    absurd.push_back(motion);
    motion = estimate(kDrawnStartUs + 5'000'000, kDrawnStartUs + 5'075'000);
    motion.information *= number;
    absurd.push_back(motion);
    motion.covariance *= number;
    absurd.push_back(motion);
    motion.gradient = Eigen::Vector3d::Constant(number);
    absurd.push_back(motion);
  }
  const int degrees_of_freedom = GENERATE(2, 3);
  const std::size_t radar = GENERATE(0U, 1U);
  for (std::size_t i = 0; i < absurd.size(); ++i) {
    CAPTURE(degrees_of_freedom, radar, i);
    const EgoMotionOptions options = drawn_options(degrees_of_freedom);
    DrawnVehicle vehicle(simulation::in_bends, drawn_radars(2), options, 2);
    FusedEstimator estimator({}, options, 2);
    bool is_done = false;
    std::optional<EgoMotion> last;
    while (vehicle.time_s() < 9.0) {
      const DrawnMotion drawn = vehicle.next();
      if (vehicle.time_s() > 5.0 && !is_done) {
        is_done = true;
        const auto fused = estimator.update(radar, absurd[i]);
        CHECK((!fused || is_sound(*fused)));
      }
      if (const auto fused = estimator.update(drawn.radar, drawn.motion)) {
        CHECK(is_sound(*fused));
        last = fused;
      }
    }
    REQUIRE(last);
    CHECK(last->has_estimate());
    const Eigen::Vector3d error = last->motion - vehicle.truth(*last);
    CHECK(error.cwiseAbs2().cwiseQuotient(last->covariance.diagonal()).maxCoeff() < 36.0);
  }
}

}  // namespace
}  // namespace cremed
