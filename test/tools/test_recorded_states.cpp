// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <sstream>
#include <string>

#include <catch2/catch.hpp>

#include "test/tools/circle.hpp"
#include "tools/eval/drive/against_wheels.hpp"
#include "tools/eval/drive/recorded_states.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

constexpr const char* kStateHeader =
    "utime,utime_anchor,status,x_m,y_m,yaw_rad,cov_xx,cov_xy,cov_xyaw,cov_yy,cov_yyaw,cov_yawyaw,"
    "odom_x_m,odom_y_m,odom_yaw_rad,vx_mps,vy_mps,yaw_rate_radps,"
    "cov_vxvx,cov_vxvy,cov_vxw,cov_vyvy,cov_vyw,cov_ww\n";

RecordedStates read_rows(const std::string& rows) {
  std::istringstream csv(kStateHeader + rows);
  return read_states(CsvTable(csv));
}

}  // namespace

TEST_CASE("The vehicle's state is told by its header and read with its covariances") {
  std::istringstream states(kStateHeader);
  std::istringstream motions("utime_start,utime,source\n");
  CHECK(holds_states(CsvTable(states)));
  CHECK_FALSE(holds_states(CsvTable(motions)));

  const auto recorded = read_rows(
      "1000,1000,initialising,nan,nan,nan,nan,nan,nan,nan,nan,nan,0,0,0,"
      "nan,nan,nan,nan,nan,nan,nan,nan,nan\n"
      "2000,2000,ok,0,0,0,0,0,0,0,0,0,0,0,0,8,0.1,0.2,1,2,3,4,5,6\n"
      "3000,2000,ok,0.1,0.2,0.3,11,12,13,14,15,16,7,7,7,8,0.1,0.2,1,2,3,4,5,6\n");
  REQUIRE(recorded.states.size() == 2);
  const Odometry& state = recorded.states[1];
  CHECK(state.utime_us == 3000);
  CHECK(state.utime_anchor_us == 2000);
  CHECK(state.pose == Eigen::Vector3d(0.1, 0.2, 0.3));
  CHECK(state.covariance(2, 1) == 15.0);
  CHECK(state.twist == Eigen::Vector3d(8.0, 0.1, 0.2));
  CHECK(state.twist_covariance(2, 0) == 3.0);
  CHECK(state.twist_covariance(1, 1) == 4.0);
  CHECK(state.twist_covariance(1, 2) == 5.0);

  const RecordedOdometry& odometry = recorded.odometry;
  CHECK(odometry.without_estimate == 1);
  REQUIRE(odometry.estimates.size() == 1);  // At its own anchor a state is no motion.
  CHECK(odometry.estimates[0].start_us == 2000);
  CHECK(odometry.estimates[0].covariance(0, 0) == 11.0);
  // The path is that of the poses since the start, from the end of "initialising" on.
  REQUIRE(odometry.steps().size() == 1);
  CHECK(odometry.steps()[0].start_us == 2000);
  CHECK(odometry.steps()[0].motion.head<2>() == Eigen::Vector2d(7.0, 7.0));
}

TEST_CASE("A state that is said to be one and is not finite is refused with the place") {
  CHECK_THROWS_WITH(
      read_rows("3000,2000,ok,0.1,0.2,0.3,11,12,13,14,15,16,7,7,7,nan,0.1,0.2,1,2,3,4,5,6\n"),
      Catch::Contains("line 2, vx_mps"));
}

TEST_CASE("The twist is compared with the wheels at the same time, by both variances") {
  const Circle circle{8.0, 0.1};
  Odometry state;
  state.utime_us = 1'005'000;
  state.twist = {8.3, 1.0, 0.06};
  state.twist_covariance = Eigen::Vector3d(0.09, 1.0, 4e-4).asDiagonal();
  Odometry late = state;
  late.utime_us = 5'000'000;
  const auto exact = against_wheels({state, late}, read_wheels(circle.wheels_csv(2.0)));
  CHECK(exact.count == 1);
  CHECK(exact.nees_speed == Approx(1.0));
  CHECK(exact.nees_yaw_rate == Approx(4.0));
  CHECK(exact.rms_speed_mps == Approx(0.3));
  CHECK(exact.rms_yaw_rate_radps == Approx(0.04));
  const auto doubted =
      against_wheels({state, state}, read_wheels(circle.wheels_csv(2.0), {0.3, 0.02}));
  CHECK(doubted.count == 2);
  CHECK(doubted.nees_speed == Approx(0.5));
  CHECK(doubted.nees_yaw_rate == Approx(2.0));
}
