// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <sstream>

#include <catch2/catch.hpp>

#include "tools/eval/drive/path_drift.hpp"

using namespace cremed;

namespace {

/// East at 10 m/s for 10 s.
TrueTrajectory straight_truth() {
  std::istringstream csv("utime,x_m,y_m,yaw_rad\n0,5,7,0\n10000000,105,7,0\n");
  return TrueTrajectory(csv);
}

RecordedEstimate estimate(std::int64_t start_us, std::int64_t end_us, double x_m, double yaw_rad) {
  return {start_us, end_us, {x_m, 0.0, yaw_rad}, Eigen::Matrix3d::Identity()};
}

}  // namespace

TEST_CASE("A motion leads from the one pose to the other between which it was measured") {
  const Pose2 start{3.0, -4.0, 2.5};
  const Pose2 end{-1.0, 8.0, 3.0};
  const Pose2 reached = moved(start, motion_between(start, end));
  CHECK(reached.x_m == Approx(end.x_m));
  CHECK(reached.y_m == Approx(end.y_m));
  CHECK(reached.yaw_rad == Approx(end.yaw_rad));
}

TEST_CASE("Estimates that join add up from the first true pose, beside the true path") {
  const double right_angle_rad = std::acos(0.0);
  const auto path = driven_path({estimate(1'000'000, 2'000'000, 9.0, right_angle_rad),
                                 estimate(2'000'000, 3'000'000, 4.0, 0.0)},
                                straight_truth());
  REQUIRE(path.size() == 3);
  CHECK(path[0].estimate.x_m == Approx(15.0));
  CHECK(path[1].utime_us == 2'000'000);
  CHECK(path[1].estimate.x_m == Approx(24.0));
  CHECK(path[2].estimate.x_m == Approx(24.0));
  CHECK(path[2].estimate.y_m == Approx(11.0));
  CHECK(path[2].truth.x_m == Approx(35.0));
  CHECK(path[2].driven_m == Approx(20.0));
  CHECK(path[2].gaps == 0);
}

TEST_CASE("A gap is crossed as truth did, and counted") {
  const auto path =
      driven_path({estimate(0, 1'000'000, 11.0, 0.0), estimate(4'000'000, 5'000'000, 12.0, 0.0)},
                  straight_truth());
  REQUIRE(path.size() == 4);
  CHECK(path[2].utime_us == 4'000'000);
  CHECK(path[2].estimate.x_m == Approx(5.0 + 11.0 + 30.0));
  CHECK(path[3].estimate.x_m == Approx(5.0 + 11.0 + 30.0 + 12.0));
  CHECK(path[3].driven_m == Approx(50.0));
  CHECK(path[1].gaps == 0);
  CHECK(path[2].gaps == 1);
  CHECK(path[3].gaps == 1);
}

TEST_CASE("Estimates outside of truth's time are no part of the path") {
  const auto path =
      driven_path({estimate(-1'000'000, 0, 10.0, 0.0), estimate(0, 1'000'000, 10.0, 0.0),
                   estimate(9'500'000, 10'500'000, 10.0, 0.0)},
                  straight_truth());
  CHECK(path.size() == 2);
  CHECK(driven_path({}, straight_truth()).empty());
}
