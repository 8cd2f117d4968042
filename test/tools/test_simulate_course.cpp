// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <catch2/catch.hpp>

#include "test/tools/simulated_drive.hpp"
#include "tools/simulate/scenario.hpp"
#include "tools/simulate/vehicle_course.hpp"

namespace {

using cremed::CoursePlan;
using cremed::Pose2;
using cremed::VehicleCourse;
using cremed::VehicleState;
using cremed::test::TruthTable;

/// Displacement from one pose to the next, in the frame of their mean heading.
struct Pace {
  double forward_mps;
  double left_mps;
  double yaw_rate_radps;
};

Pace pace(const Pose2& from, const Pose2& to, double dt_s) {
  const double yaw = 0.5 * (from.yaw_rad + to.yaw_rad);
  const double dx = to.x_m - from.x_m;
  const double dy = to.y_m - from.y_m;
  return {(std::cos(yaw) * dx + std::sin(yaw) * dy) / dt_s,
          (std::cos(yaw) * dy - std::sin(yaw) * dx) / dt_s, (to.yaw_rad - from.yaw_rad) / dt_s};
}

/// Limits of a scenario's motion.
struct CarLimits {
  double sideways_mps = 1e-4;
  double slowest_mps = 0.0;
  double along_mps2 = 3.3;
  double across_mps2 = 3.7;
  double jerk_mps3 = 8.0;
  double curvature_1pm = 0.15;
};

CarLimits limits_of(std::string_view name) {
  CarLimits limits;
  if (name == "reversing") limits.slowest_mps = -5.0;
  if (name == "braking") {
    limits.along_mps2 = 8.8;
    limits.jerk_mps3 = 11.0;
  }
  // A turning circle of 12 m, measured at the outer front wheel.
  if (name == "garage" || name == "u-turn") limits.curvature_1pm = 0.18;
  // A robot, not a car.
  if (name == "campus") limits.curvature_1pm = 1.31;
  if (name == "skid") {
    limits.sideways_mps = 2.51;
    limits.across_mps2 = 7.0;
  }
  return limits;
}

std::string truth_csv(const std::string& name) {
  cremed::Simulation simulation(cremed::test::scenario(name), cremed::default_radars(), {});
  return simulation.truth_csv();
}

}  // namespace

TEST_CASE("a course of constant speed and curvature is a circle") {
  const CoursePlan circle{5.0, {{10.0, 5.0, 0.1}}, 0.1};
  const VehicleCourse course(circle, 30.0);
  for (const double time_s : {0.0, 0.004, 1.0, 7.77777, 29.999}) {
    CAPTURE(time_s);
    const VehicleState state = course.at(time_s);
    const double angle = 0.5 * time_s;
    CHECK(state.pose.yaw_rad == Approx(angle).margin(1e-9));
    CHECK(state.pose.x_m == Approx(10.0 * std::sin(angle)).margin(1e-8));
    CHECK(state.pose.y_m == Approx(10.0 * (1.0 - std::cos(angle))).margin(1e-8));
    CHECK(state.distance_m == Approx(5.0 * time_s).margin(1e-9));
  }
}

TEST_CASE("a start covers half the final speed times its duration, and legs repeat") {
  const CoursePlan start_and_stop{0.0, {{4.0, 8.0, 0.0}, {4.0, 0.0, 0.0}}};
  const VehicleCourse course(start_and_stop, 20.0);
  CHECK(course.at(4.0).pose.x_m == Approx(16.0).margin(1e-9));
  CHECK(course.at(8.0).pose.x_m == Approx(32.0).margin(1e-9));
  CHECK(course.at(12.0).pose.x_m == Approx(48.0).margin(1e-9));
  CHECK(course.at(2.0).speed_mps == Approx(4.0));
  CHECK(course.at(10.0).speed_mps == Approx(4.0));
}

TEST_CASE("a plan that cannot be driven is refused") {
  CHECK_THROWS_AS(VehicleCourse({0.0, {}}, 1.0), std::invalid_argument);
  CHECK_THROWS_AS(VehicleCourse({0.0, {{1.005, 1.0, 0.0}}}, 1.0), std::invalid_argument);
  CHECK_THROWS_AS(VehicleCourse({0.0, {{0.0, 1.0, 0.0}}}, 1.0), std::invalid_argument);
}

TEST_CASE("every scenario drives as a car can") {
  const auto& scenario = GENERATE(from_range(cremed::scenarios()));
  CAPTURE(std::string(scenario.name));
  const TruthTable truth(truth_csv(std::string(scenario.name)));
  const auto& rows = truth.rows();
  REQUIRE(rows.size() == static_cast<std::size_t>(scenario.duration_s * 100.0) + 1);
  double sideways_mps = 0.0;
  double along_mps2 = 0.0;
  double across_mps2 = 0.0;
  double jerk_mps3 = 0.0;
  double curvature_1pm = 0.0;
  double slowest_mps = 0.0;
  std::vector<Pace> motions;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    REQUIRE(rows[i].stamp_us - rows[i - 1].stamp_us == 10'000);
    motions.push_back(pace(rows[i - 1].pose, rows[i].pose, 0.01));
    const Pace& m = motions.back();
    sideways_mps = std::max(sideways_mps, std::abs(m.left_mps));
    slowest_mps = std::min(slowest_mps, m.forward_mps);
    across_mps2 = std::max(across_mps2, std::abs(m.forward_mps * m.yaw_rate_radps));
    if (m.forward_mps > 0.5) {
      curvature_1pm = std::max(curvature_1pm, std::abs(m.yaw_rate_radps / m.forward_mps));
    }
  }
  std::vector<double> accelerations;
  for (std::size_t i = 1; i < motions.size(); ++i) {
    accelerations.push_back((motions[i].forward_mps - motions[i - 1].forward_mps) / 0.01);
    along_mps2 = std::max(along_mps2, std::abs(accelerations.back()));
  }
  for (std::size_t i = 1; i < accelerations.size(); ++i) {
    jerk_mps3 = std::max(jerk_mps3, std::abs(accelerations[i] - accelerations[i - 1]) / 0.01);
  }
  const CarLimits limits = limits_of(scenario.name);
  CHECK(sideways_mps < limits.sideways_mps);
  CHECK(slowest_mps > limits.slowest_mps - 1e-6);
  CHECK(along_mps2 < limits.along_mps2);
  CHECK(across_mps2 < limits.across_mps2);
  CHECK(jerk_mps3 < limits.jerk_mps3);
  CHECK(curvature_1pm < limits.curvature_1pm);
}

TEST_CASE("scenarios move at the speeds they promise") {
  struct Row {
    std::string name;
    double slowest_mps;
    double fastest_mps;
  };
  const auto row =
      GENERATE(Row{"straight", 14.0, 20.0}, Row{"bends", 5.0, 16.0}, Row{"stop-and-go", 0.0, 11.0},
               Row{"standing", 0.0, 0.0}, Row{"city", 0.0, 19.0}, Row{"tunnel", 15.0, 20.0},
               Row{"jam", 0.0, 6.0}, Row{"reversing", -5.0, 3.0}, Row{"braking", 0.0, 20.0},
               Row{"roundabout", 5.5, 10.0}, Row{"garage", 0.0, 3.0}, Row{"u-turn", 3.0, 8.0},
               Row{"slow-start", 0.0, 11.0});
  CAPTURE(row.name);
  const VehicleCourse course(cremed::test::scenario(row.name).course,
                             cremed::test::scenario(row.name).duration_s);
  const auto [slowest, fastest] = std::minmax_element(
      course.steps().begin(), course.steps().end(),
      [](const VehicleState& a, const VehicleState& b) { return a.speed_mps < b.speed_mps; });
  CHECK(slowest->speed_mps == Approx(row.slowest_mps).margin(1e-9));
  CHECK(fastest->speed_mps == Approx(row.fastest_mps).epsilon(0.03).margin(1e-9));
}

TEST_CASE("a skidding vehicle's path is not where it looks to") {
  const CoursePlan plan{10.0, {{2.0, 10.0, 0.0, -2.0}, {3.0, 10.0, 0.0, -2.0}}};
  const VehicleCourse course(plan, 5.0);
  const VehicleState before = course.at(2.0);
  const VehicleState after = course.at(5.0);
  CHECK(after.side_speed_mps == -2.0);
  CHECK(after.pose.yaw_rad == 0.0);
  CHECK(after.pose.x_m - before.pose.x_m == Approx(30.0));
  CHECK(after.pose.y_m - before.pose.y_m == Approx(-6.0));
  CHECK(after.distance_m - before.distance_m == Approx(3.0 * std::hypot(10.0, 2.0)));
}

TEST_CASE("standing truly stands, straight is straight, bends go both ways") {
  const TruthTable standing(truth_csv("standing"));
  for (const auto& row : standing.rows()) {
    REQUIRE(row.pose.x_m == 0.0);
    REQUIRE(row.pose.y_m == 0.0);
    REQUIRE(row.pose.yaw_rad == 0.0);
  }
  const TruthTable straight(truth_csv("straight"));
  for (const auto& row : straight.rows()) REQUIRE(row.pose.y_m == 0.0);
  const VehicleCourse bends(cremed::test::scenario("bends").course, 60.0);
  const auto [right, left] = std::minmax_element(bends.steps().begin(), bends.steps().end(),
                                                 [](const VehicleState& a, const VehicleState& b) {
                                                   return a.yaw_rate_radps < b.yaw_rate_radps;
                                                 });
  CHECK(right->yaw_rate_radps < -0.25);
  CHECK(left->yaw_rate_radps > 0.25);
}

TEST_CASE("a line between two rows of the truth is off by what accelerations make it") {
  const auto& scenario = GENERATE(from_range(cremed::scenarios()));
  CAPTURE(std::string(scenario.name));
  const cremed::SimulationOptions options;
  cremed::Simulation simulation(scenario, cremed::default_radars(), options);
  const TruthTable truth(simulation.truth_csv());
  double worst_m = 0.0;
  double worst_rad = 0.0;
  for (int moment = 0; 0.0033 * moment < scenario.duration_s; ++moment) {
    const double time_s = 0.0033 * moment;
    const Pose2 line = truth.at(static_cast<double>(options.start_us) + 1e6 * time_s);
    const Pose2 exact = simulation.scene().course().at(time_s).pose;
    worst_m = std::max(worst_m, std::hypot(line.x_m - exact.x_m, line.y_m - exact.y_m));
    worst_rad = std::max(worst_rad, std::abs(line.yaw_rad - exact.yaw_rad));
  }
  CAPTURE(worst_m, worst_rad);
  // A chord of 10 ms; a car that skids accelerates sideways on top of that.
  const CarLimits limits = limits_of(scenario.name);
  const double greatest_mps2 = limits.along_mps2 + limits.across_mps2;
  CHECK(worst_m < greatest_mps2 * 0.01 * 0.01 / 8.0);
  CHECK(worst_rad < 2e-5);
}
