// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <sstream>
#include <string>

#include <catch2/catch.hpp>

#include "tools/eval/drive/drive_evaluation.hpp"

using namespace cremed;

namespace {

constexpr const char* kMotionHeader =
    "utime_start,utime,source,x_m,y_m,yaw_rad,cov_xx,cov_xy,cov_xyaw,cov_yy,cov_yyaw,cov_yawyaw,"
    "status,targets,iterations,solve_us\n";

/// Drives 10 m/s to the north-east, turning left by 0.1 rad/s (numbers, not a real arc).
TrueTrajectory turning_truth() {
  std::istringstream csv(
      "utime,x_m,y_m,yaw_rad\n"
      "1000000,100,200,0.785398163397448\n"
      "2000000,107.0710678,207.0710678,0.885398163397448\n");
  return TrueTrajectory(csv);
}

std::vector<SourceEvaluation> evaluate(const std::string& rows) {
  std::istringstream csv(kMotionHeader + rows);
  return evaluate_drive(csv, {turning_truth(), {}, {}});
}

}  // namespace

TEST_CASE("Truth is interpolated and turned into the start's frame") {
  const auto pose = turning_truth().at(1'250'000);
  REQUIRE(pose);
  CHECK(pose->x_m == Approx(101.76776695));
  CHECK(pose->yaw_rad == Approx(0.810398163397448));
  const auto motion = turning_truth().motion(1'000'000, 1'100'000);
  REQUIRE(motion);
  CHECK(motion->x() == Approx(1.0));
  CHECK(motion->y() == Approx(0.0).margin(1e-6));
  CHECK(motion->z() == Approx(0.01));
  CHECK_FALSE(turning_truth().at(999'999));
  CHECK(turning_truth().at(2'000'000));
  CHECK_FALSE(turning_truth().at(2'000'001));
}

TEST_CASE("Truth is not interpolated where poses are missing") {
  std::istringstream csv(
      "utime,x_m,y_m,yaw_rad\n"
      "0,0,0,0\n100000,1,0,0\n200000,2,0,0\n450000,4,0,0\n550000,5,0,0\n5550000,5,9,1\n"
      "5650000,6,9,1\n");
  const TrueTrajectory truth(csv);
  REQUIRE(truth.gaps().size() == 1);
  CHECK(truth.gaps()[0].begin_us == 550'000);
  CHECK(truth.gaps()[0].end_us == 5'550'000);
  CHECK(truth.at(300'000));
  CHECK(truth.at(550'000));
  CHECK_FALSE(truth.at(550'001));
  CHECK(truth.at(5'550'000));
  CHECK(truth.motion(0, 550'000));
  CHECK(truth.motion(0, 5'550'000));
  CHECK(truth.touches_gap(0, 5'550'000));
  CHECK_FALSE(truth.touches_gap(0, 550'000));
  CHECK(truth.motion(5'550'000, 5'600'000));
  std::istringstream slow("utime,x_m,y_m,yaw_rad\n0,0,0,0\n1000000,9,0,0\n3000000,9,9,1\n");
  CHECK(TrueTrajectory(slow).gaps().empty());
}

TEST_CASE("Yaw is interpolated the short way round") {
  std::istringstream csv("utime,x_m,y_m,yaw_rad\n0,0,0,3.1\n1000000,0,0,-3.1\n");
  const TrueTrajectory trajectory(csv);
  const auto motion = trajectory.motion(0, 500'000);
  REQUIRE(motion);
  CHECK(motion->z() == Approx(2.0 * 3.14159265358979 - 6.2).epsilon(1e-9).margin(0.05));
  CHECK(std::abs(motion->z()) < 0.05);
}

TEST_CASE("Sources are told apart; rows without estimate and outside of truth are counted") {
  const auto sources = evaluate(
      "1000000,1100000,front,1.1,0,0.01,0.01,0,0,0,0,0.0001,ok,50,6,0\n"
      "1000000,1000000,rear,nan,nan,nan,nan,nan,nan,nan,nan,nan,no_reference,50,0,0\n"
      "1100000,1200000,front,1.0,0,0.01,0.01,0,0,0,0,0.0001,standing_still,50,6,0\n"
      "1900000,2100000,front,2.0,0,0.02,0.01,0,0,0,0,0.0001,ok,50,6,0\n");
  REQUIRE(sources.size() == 2);
  CHECK(sources[0].source == "front");
  CHECK(sources[0].credibility.count() == 2);
  CHECK(sources[0].outside_truth == 1);
  // Errors of one sigma in x once: NEES of 2 DoF 1/2 and 0.
  CHECK(sources[0].credibility.anees() == Approx(0.25).margin(1e-6));
  // The second motion's truth is seen from a vehicle turned by 0.01 rad: 0.01 m to the right.
  CHECK(sources[0].credibility.rmse_m() == Approx(std::sqrt((0.01 + 0.0001) / 2.0)).epsilon(1e-4));
  CHECK(sources[1].credibility.count() == 0);
  CHECK(sources[1].without_estimate == 1);
}

TEST_CASE("All radars together come first, the others as they appear") {
  const auto sources = evaluate(
      "1000000,1100000,rear,1.0,0,0.01,0.01,0,0,0,0,0.0001,ok,50,6,0\n"
      "1000000,1100000,front,1.0,0,0.01,0.01,0,0,0,0,0.0001,ok,50,6,0\n"
      "1000000,1100000,fused,1.0,0,0.01,0.01,0,0,0.04,0,0.0001,ok,50,6,0\n");
  REQUIRE(sources.size() == 3);
  CHECK(sources[0].source == "fused");
  CHECK(sources[1].source == "rear");
  CHECK(sources[2].source == "front");
}

TEST_CASE("A covariance with y is evaluated in three degrees of freedom") {
  const auto sources =
      evaluate("1000000,1100000,front,1.0,0.2,0.01,0.01,0,0,0.04,0,0.0001,ok,50,6,0\n");
  CHECK(sources[0].credibility.anees() == Approx(1.0 / 3.0).margin(1e-6));
}

TEST_CASE("Each estimate's error, sigma and NEES are told, with the path they make") {
  const auto sources = evaluate(
      "1000000,1100000,front,1.1,0,0.03,0.01,0,0,0,0,0.0001,ok,50,6,0\n"
      "1100000,1200000,front,1.0,0,0.01,0.01,0,0,0,0,0.0001,ok,50,6,0\n"
      "1300000,1400000,front,1.0,0,0.01,0.01,0,0,0,0,0.0001,ok,50,6,0\n");
  const SourceEvaluation& front = sources[0];
  CHECK(front.degrees_of_freedom == 2);
  REQUIRE(front.errors.size() == 3);
  CHECK(front.errors[0].utime_us == 1'100'000);
  CHECK(front.errors[0].error.x() == Approx(0.1).margin(1e-6));
  CHECK(front.errors[0].error.z() == Approx(0.02));
  CHECK(front.errors[0].sigma.x() == Approx(0.1));
  CHECK(front.errors[0].sigma.z() == Approx(0.01));
  CHECK(front.errors[0].nees == Approx((1.0 + 4.0) / 2.0).epsilon(1e-5));
  CHECK(front.errors[0].estimate.forward_mps == Approx(11.0));
  CHECK(front.errors[0].truth.forward_mps == Approx(10.0));
  CHECK(front.errors[0].estimate.yaw_radps == Approx(0.3));
  CHECK(front.errors[0].truth.yaw_radps == Approx(0.1));
  REQUIRE(front.mean_nees.size() == 3);
  CHECK(front.mean_nees[2].mean == Approx(front.credibility.anees()));
  REQUIRE(front.path.size() == 5);
  CHECK(front.path.back().gaps == 1);
  CHECK(front.drift.size() == 10);
}

TEST_CASE("What is no odometry or no truth is refused with the place") {
  CHECK_THROWS_WITH(evaluate("1,2,3\n"), Catch::Contains("line 2"));
  CHECK_THROWS_WITH(evaluate("1000000,1100000,front,x,0,0.01,0.01,0,0,0.04,0,0.0001,ok,50,6,0\n"),
                    Catch::Contains("line 2, x_m: 'x' is not a number"));
  CHECK_THROWS_WITH(evaluate("1000000,1100000,front,nan,0,0.01,0.01,0,0,0.04,0,0.0001,ok,50,6,0\n"),
                    Catch::Contains("not finite"));
  std::istringstream unsorted("utime,x_m,y_m,yaw_rad\n5,0,0,0\n5,0,0,0\n");
  CHECK_THROWS_WITH(TrueTrajectory(unsorted), Catch::Contains("row 2: utime does not increase"));
  for (const char* const number : {"nan", "inf", "-inf"}) {
    std::istringstream infinite(std::string("utime,x_m,y_m,yaw_rad\n5,0,0,0\n# lost\n6,0,") +
                                number + ",0\n");
    CHECK_THROWS_WITH(TrueTrajectory(infinite),
                      Catch::Contains(std::string("line 4, y_m: '") + number + "' is not finite"));
  }
  std::istringstream incomplete("utime,x_m,y_m\n5,0,0\n");
  CHECK_THROWS_WITH(TrueTrajectory(incomplete), Catch::Contains("no column yaw_rad"));
}
