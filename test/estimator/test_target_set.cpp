// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "cremed/estimator/scan/target_set.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using numeric::kInfinity;
using numeric::kNan;
using simulation::Random;
using simulation::uniform;

constexpr double kPi = 3.1415926535897932;

Detection usable_detection(double range_m = 20.0, double azimuth_rad = 0.3) {
  Detection detection;
  detection.range_m = range_m;
  detection.azimuth_rad = azimuth_rad;
  detection.doppler_mps = -3.0;
  detection.range_std_m = 0.2;
  detection.azimuth_std_rad = 0.01;
  detection.doppler_std_mps = 0.1;
  detection.rcs_dbm2 = 5.0;
  detection.validity = Validity::usable;
  return detection;
}

Pose2 random_mount(Random& random) {
  return {uniform(random, -2.0, 4.0), uniform(random, -1.0, 1.0), uniform(random, -kPi, kPi)};
}

Eigen::Vector2d to_point(const Eigen::Vector2d& polar, const Pose2& mount) {
  return simulation::as_vector(mount).head<2>() +
         Eigen::Rotation2Dd(mount.yaw_rad) *
             (Eigen::Rotation2Dd(polar.y()) * Eigen::Vector2d::UnitX()) * polar.x();
}

TEST_CASE("a detection becomes a point in the vehicle frame") {
  struct Row {
    double range_m, azimuth_rad;
    Pose2 mount;
    double x_m, y_m, bearing_rad;
  };
  const std::vector<Row> rows = {
      {3.0, 0.0, {}, 3.0, 0.0, 0.0},
      {3.0, kPi / 2, {}, 0.0, 3.0, kPi / 2},
      {3.0, -kPi / 2, {}, 0.0, -3.0, -kPi / 2},
      {3.0, 0.0, {4.0, 0.5, 0.0}, 7.0, 0.5, 0.0},
      {3.0, 0.0, {2.0, 1.0, kPi / 2}, 2.0, 4.0, kPi / 2},
      {3.0, kPi / 2, {2.0, 1.0, kPi / 2}, -1.0, 1.0, kPi},
      {3.0, -kPi / 2, {-1.0, 0.0, kPi}, -1.0, 3.0, kPi / 2},
  };
  for (const Row& row : rows) {
    CAPTURE(row.range_m, row.azimuth_rad, row.mount.x_m, row.mount.y_m, row.mount.yaw_rad);
    const TargetSet set =
        simulation::targets({usable_detection(row.range_m, row.azimuth_rad)}, row.mount);
    REQUIRE(set.size() == 1);
    CHECK(set[0].x_m == Approx(row.x_m).margin(1e-12));
    CHECK(set[0].y_m == Approx(row.y_m).margin(1e-12));
    CHECK(set[0].bearing_rad == Approx(row.bearing_rad).margin(1e-12));
  }
}

TEST_CASE("a target has the Doppler and the line-of-sight noise of its detection") {
  const Target target = simulation::targets({usable_detection()}, {3.0, 0.5, 1.0})[0];
  CHECK(target.doppler_mps == -3.0);
  CHECK(target.doppler_std_mps == 0.1);
  CHECK(target.bearing_std_rad == 0.01);
}

TEST_CASE("the covariance is that of polar noise to first order, for every mount") {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Pose2 mount = random_mount(random);
    const double range_m = uniform(random, 0.3, 200.0);
    Detection detection = usable_detection(range_m, uniform(random, -kPi, kPi));
    detection.range_std_m = uniform(random, 0.01, 1.0);
    detection.azimuth_std_rad = uniform(random, 0.001, 0.2);
    const Eigen::Vector2d polar(detection.range_m, detection.azimuth_rad);
    const Eigen::Matrix2d jacobian = numeric::central_differences(
        polar, 1e-5, [&](const Eigen::Vector2d& p) { return to_point(p, mount); });
    const Eigen::Vector2d sigma(detection.range_std_m, detection.azimuth_std_rad);
    const Eigen::Matrix2d expected =
        jacobian * sigma.cwiseAbs2().asDiagonal() * jacobian.transpose();
    const Target target = simulation::targets({detection}, mount)[0];
    CHECK((numeric::matrix(target.covariance_m2) - expected).norm() < 1e-8 * expected.norm());
  }
}

TEST_CASE("the covariance is that of a sample of noisy detections") {
  constexpr int kSamples = 40000;
  Random random(2);
  const Pose2 mount{1.0, -0.5, 2.0};
  const Detection truth = usable_detection(20.0, -0.4);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d sum_of_squares = Eigen::Matrix2d::Zero();
  const Eigen::Vector2d centre = to_point({truth.range_m, truth.azimuth_rad}, mount);
  for (int i = 0; i < kSamples; ++i) {
    simulation::Detections noisy = {truth};
    simulation::perturb(noisy, random);
    const Eigen::Vector2d point =
        to_point({noisy[0].range_m, noisy[0].azimuth_rad}, mount) - centre;
    sum += point;
    sum_of_squares += point * point.transpose();
  }
  const Eigen::Vector2d mean = sum / kSamples;
  const Eigen::Matrix2d sample = sum_of_squares / kSamples - mean * mean.transpose();
  const Symmetric2 c = simulation::targets({truth}, mount)[0].covariance_m2;
  // Four standard deviations of a sample covariance; curvature adds (0.01 rad)^2 of it at most.
  const double root = std::sqrt(static_cast<double>(kSamples));
  CHECK(std::abs(sample(0, 0) - c.xx) < 4.0 * std::sqrt(2.0) * c.xx / root);
  CHECK(std::abs(sample(1, 1) - c.yy) < 4.0 * std::sqrt(2.0) * c.yy / root);
  CHECK(std::abs(sample(0, 1) - c.xy) < 4.0 * std::sqrt(c.xx * c.yy + c.xy * c.xy) / root);
}

TEST_CASE("each rejected detection is counted under its reason") {
  struct Row {
    std::string what;
    void (*change)(Detection&);
    std::uint64_t SelectionCounters::*counter;
  };
  const std::vector<Row> rows = {
      {"usable", [](Detection&) {}, &SelectionCounters::used},
      {"no noise", [](Detection& d) { d.validity = Validity::no_noise; },
       &SelectionCounters::no_noise},
      {"invalid", [](Detection& d) { d.validity = Validity::invalid_state; },
       &SelectionCounters::invalid_state},
      {"moving", [](Detection& d) { d.validity = Validity::moving; }, &SelectionCounters::moving},
      {"ghost", [](Detection& d) { d.validity = Validity::low_existence; },
       &SelectionCounters::low_existence},
      {"no position", [](Detection& d) { d.validity = Validity::no_position; },
       &SelectionCounters::no_position},
      {"empty", [](Detection& d) { d.validity = Validity::empty; },
       &SelectionCounters::no_position},
      {"nearest", [](Detection& d) { d.range_m = 1.0; }, &SelectionCounters::used},
      {"too near", [](Detection& d) { d.range_m = 0.999; }, &SelectionCounters::outside_limits},
      {"farthest", [](Detection& d) { d.range_m = 100.0; }, &SelectionCounters::used},
      {"too far", [](Detection& d) { d.range_m = 100.1; }, &SelectionCounters::outside_limits},
      {"left edge", [](Detection& d) { d.azimuth_rad = 0.5; }, &SelectionCounters::used},
      {"left", [](Detection& d) { d.azimuth_rad = 0.51; }, &SelectionCounters::outside_limits},
      {"right edge", [](Detection& d) { d.azimuth_rad = -0.5; }, &SelectionCounters::used},
      {"right", [](Detection& d) { d.azimuth_rad = -0.51; }, &SelectionCounters::outside_limits},
      {"faintest", [](Detection& d) { d.rcs_dbm2 = -10.0; }, &SelectionCounters::used},
      {"too faint", [](Detection& d) { d.rcs_dbm2 = -10.1; }, &SelectionCounters::outside_limits},
  };
  constexpr std::array kAll = {&SelectionCounters::used,          &SelectionCounters::no_noise,
                               &SelectionCounters::invalid_state, &SelectionCounters::moving,
                               &SelectionCounters::low_existence, &SelectionCounters::no_position,
                               &SelectionCounters::outside_limits};
  const DetectionLimits limits{1.0, 100.0, 0.5, -10.0};
  for (const Row& row : rows) {
    CAPTURE(row.what);
    Detection changed = usable_detection();
    row.change(changed);
    TargetSet set;
    SelectionCounters counters;
    set.assign(simulation::scan({usable_detection(7.0), changed, usable_detection(9.0)}, 0), {},
               limits, counters);
    const bool is_used = row.counter == &SelectionCounters::used;
    CHECK(set.size() == (is_used ? 3U : 2U));
    CHECK(std::hypot(set[set.size() - 1].x_m, set[set.size() - 1].y_m) == Approx(9.0));
    for (const auto counter : kAll) {
      const std::uint64_t of_neighbours = counter == &SelectionCounters::used ? 2 : 0;
      CHECK(counters.*counter == of_neighbours + (counter == row.counter ? 1U : 0U));
    }
  }
}

TEST_CASE("assigning a scan replaces the targets and adds to the counters") {
  TargetSet set;
  SelectionCounters counters;
  set.assign(simulation::scan({usable_detection(5.0), usable_detection(6.0)}, 0), {}, {}, counters);
  set.assign(simulation::scan({usable_detection(7.0)}, 0), {}, {}, counters);
  REQUIRE(set.size() == 1);
  CHECK(std::hypot(set[0].x_m, set[0].y_m) == Approx(7.0));
  CHECK(counters.used == 3);
  set.clear();
  CHECK(set.begin() == set.end());
}

TEST_CASE("assigning corrects the targets") {
  TargetSet set;
  SelectionCounters counters;
  const DetectionCorrection correction{.doppler_offset_mps = 0.5,
                                       .doppler_scale = 1.5,
                                       .range_std_factor = 2.0,
                                       .azimuth_std_factor = 3.0,
                                       .doppler_std_factor = 4.0};
  set.assign(simulation::scan({usable_detection(10.0, 0.0)}, 0), {}, {}, counters, correction);
  REQUIRE(set.size() == 1);
  CHECK(set[0].doppler_mps == Approx(-5.25));
  CHECK(set[0].doppler_std_mps == Approx(0.4));
  CHECK(set[0].bearing_std_rad == Approx(0.03));
  CHECK(set[0].covariance_m2.xx == Approx(0.16));
  CHECK(set[0].covariance_m2.yy == Approx(0.09));
}

TEST_CASE("an azimuth scale moves targets about the radar and leaves range and Doppler") {
  TargetSet set;
  SelectionCounters counters;
  set.assign(simulation::scan({usable_detection(10.0, 0.5)}, 0), {1.0, 2.0, 0.3}, {}, counters,
             {.azimuth_scale = 1.02});
  REQUIRE(set.size() == 1);
  CHECK(set[0].bearing_rad == Approx(0.3 + 0.51));
  CHECK(set[0].sin_bearing == Approx(std::sin(0.81)));
  CHECK(set[0].x_m == Approx(1.0 + 10.0 * std::cos(0.81)));
  CHECK(set[0].y_m == Approx(2.0 + 10.0 * std::sin(0.81)));
  CHECK(set[0].doppler_mps == usable_detection(10.0, 0.5).doppler_mps);
}

TEST_CASE("a full set ignores further targets") {
  TargetSet set;
  for (std::size_t i = 0; i < kMaxDetections; ++i) {
    set.add(usable_detection(1.0 + static_cast<double>(i), 0.0), {});
  }
  REQUIRE(set.size() == kMaxDetections);
  set.add(usable_detection(1000.0, 0.0), {});
  CHECK(set.size() == kMaxDetections);
  CHECK(set[kMaxDetections - 1].x_m == Approx(256.0));
}

TEST_CASE("a count beyond the capacity of a scan is limited") {
  RadarScan scan;
  scan.detections.fill(usable_detection());
  scan.count = 65535;
  TargetSet set;
  SelectionCounters counters;
  set.assign(scan, {}, {}, counters);
  CHECK(set.size() == kMaxDetections);
  CHECK(counters.used == kMaxDetections);
}

constexpr std::array kMeasurements = {&Detection::range_m, &Detection::azimuth_rad,
                                      &Detection::doppler_mps};
constexpr std::array kDeviations = {&Detection::range_std_m, &Detection::azimuth_std_rad,
                                    &Detection::doppler_std_mps};

/// Whether a set is finite in which one target has `field` = value.
bool is_finite_with(double Detection::*field, double value, double azimuth_rad = 0.3) {
  Detection changed = usable_detection(20.0, azimuth_rad);
  changed.*field = value;
  return simulation::targets({usable_detection(), changed, usable_detection()}, {2.0, 0.0, 0.1})
      .is_finite();
}

TEST_CASE("is_finite detects NaN and infinity in every field") {
  CHECK(TargetSet().is_finite());
  CHECK(is_finite_with(&Detection::range_m, 21.0));
  for (const double value : {kNan, kInfinity, -kInfinity}) {
    for (const auto field : kMeasurements) {
      CHECK_FALSE(is_finite_with(field, value));
    }
    for (const auto field : kDeviations) {
      CHECK_FALSE(is_finite_with(field, value));
    }
  }
}

TEST_CASE("is_finite detects a Doppler deviation that is not greater than zero") {
  CHECK_FALSE(is_finite_with(&Detection::doppler_std_mps, 0.0));
  CHECK_FALSE(is_finite_with(&Detection::doppler_std_mps, -0.1));
}

TEST_CASE("is_finite detects a singular covariance along or across the axis") {
  CHECK_FALSE(is_finite_with(&Detection::range_std_m, 0.0, -0.1));  // bearing 0 in that mount
  CHECK_FALSE(is_finite_with(&Detection::azimuth_std_rad, 0.0, -0.1));
}

TEST_CASE("is_finite detects a range or azimuth deviation that is not greater than zero") {
  int missed = 0;
  for (int i = -30; i <= 30; ++i) {
    const double azimuth_rad = 0.1 * i;
    for (const double value : {0.0, -0.01}) {
      missed += is_finite_with(&Detection::range_std_m, value, azimuth_rad) ? 1 : 0;
      missed += is_finite_with(&Detection::azimuth_std_rad, value, azimuth_rad) ? 1 : 0;
    }
  }
  CHECK(missed == 0);
}

}  // namespace
}  // namespace cremed
