// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/fusion/state/learned_errors.hpp"
#include "test/estimator/odometry_drive.hpp"

namespace cremed {
namespace {

using simulation::OdometryDrive;
using Learned = std::vector<std::optional<LearnedErrors>>;

const std::vector<Pose2> kThreeMounts{simulation::kFront, simulation::kRearLeft,
                                      simulation::kRearRight};

/// True minus configured yaw of the mounts: 1 sigma.
const std::vector<double> kYawErrorsRad{0.0075, -0.0060, 0.0030};

OdometryDrive a_drive(std::uint64_t seed, const Learned& learned = {}) {
  OdometryDrive drive(kThreeMounts, seed, {}, learned);
  for (std::size_t i = 0; i < kThreeMounts.size(); ++i) {
    drive.radar(i).mount.yaw_rad += kYawErrorsRad[i];
  }
  drive.set_motion(10.0, 0.0);
  return drive;
}

/// Front mount's yaw minus the mean of the rear ones, which slip does not affect.
struct Difference {
  double error_rad = 0.0;
  double std_rad = 0.0;
};

Difference difference(const OdometryFilter& filter) {
  const Eigen::Vector3d by_mount(1.0, -0.5, -0.5);
  const std::vector<int> states{state_layout::radar(0) + state_layout::kMountYaw,
                                state_layout::radar(1) + state_layout::kMountYaw,
                                state_layout::radar(2) + state_layout::kMountYaw};
  const Eigen::Vector3d truth(kYawErrorsRad[0], kYawErrorsRad[1], kYawErrorsRad[2]);
  const Eigen::Vector3d mean = filter.state().mean()(states);
  const Eigen::Matrix3d covariance = filter.state().covariance()(states, states);
  return {by_mount.dot(mean - truth), std::sqrt(by_mount.dot(covariance * by_mount))};
}

}  // namespace

TEST_CASE("The common error of all radars is as uncertain at a restart as before") {
  const std::vector<LearnedError> unlearned(4, {0.0, 0.01});
  const SharedPrior prior = prior_after({LearnedError{0.004, 0.002}, LearnedError{0.006, 0.001},
                                         std::nullopt, LearnedError{0.011, 0.02}},
                                        unlearned, 0.001);
  // The mean is subtracted; sigma includes restart_std, at least a quarter and at most the
  // unlearned.
  CHECK(prior.own[0].value == Approx(-0.003));
  CHECK(prior.own[1].value == Approx(-0.001));
  CHECK(prior.own[3].value == Approx(0.004));
  CHECK(prior.own[0].std == Approx(0.0025));
  CHECK(prior.own[1].std == Approx(0.0025));
  CHECK(prior.own[3].std == Approx(0.01));
  CHECK(prior.common_variance == Approx(0.01 * 0.01 / 3.0));
  // The new radar has the unlearned prior.
  CHECK_FALSE(prior.own[2].is_learned);
  CHECK(prior.own[2].value == 0.0);
  CHECK(prior.own[2].std == 0.01);
}

TEST_CASE("Differences are relative to the weighted mean, with their own sigma") {
  // Both known except for the common error.
  Eigen::Matrix2d covariance;
  covariance << 1.01e-4, 1e-4, 1e-4, 1.01e-4;
  const auto same =
      differences(Eigen::Vector2d(0.004, 0.002), covariance, {{0.0, 0.01}, {0.0, 0.01}});
  REQUIRE(same.size() == 2);
  CHECK(same[0].value == Approx(0.001));
  CHECK(same[1].value == Approx(-0.001));
  CHECK(same[0].std == Approx(0.001));  // Their difference has a variance of 2e-6.
  const auto other =
      differences(Eigen::Vector2d(0.004, 0.002), covariance, {{0.0, 0.01}, {0.0, 0.02}});
  CHECK(other[0].value == Approx(0.0004));
  CHECK(other[1].value == Approx(-0.0016));
  CHECK(differences(Eigen::VectorXd::Zero(1), Eigen::MatrixXd::Identity(1, 1), {{0.0, 0.01}})
            .empty());
}

TEST_CASE("A sigma taken over includes the learned one and the change between drives") {
  const double learned_std = GENERATE(1e-5, 0.001, 0.003, 0.006, 0.01);
  const SharedPrior prior = prior_after({LearnedError{0.0, learned_std}, LearnedError{0.0, 0.001}},
                                        {{0.0, 0.01}, {0.0, 0.01}}, 0.001);
  CHECK(prior.own[0].std >= std::min(0.01, std::hypot(learned_std, 0.001)));
  CHECK(prior.own[0].std <= 0.01);
}

TEST_CASE("A value taken over may be wrong altogether") {
  const double value = GENERATE(0.002, 0.02, 0.05);
  const SharedPrior prior = prior_after({LearnedError{value, 1e-5}, LearnedError{-value, 1e-5}},
                                        {{0.0, 0.01}, {0.0, 0.01}}, 0.0);
  CHECK(prior.own[0].value == Approx(value));
  CHECK(prior.own[0].std == Approx(std::max(0.0025, 0.25 * value)));
}

TEST_CASE("A single radar's errors cannot be separated from slip and speed") {
  const SharedPrior prior = prior_after({LearnedError{0.004, 0.001}}, {{0.0, 0.01}}, 0.001);
  CHECK_FALSE(prior.own[0].is_learned);
  CHECK(prior.own[0].value == 0.0);
  CHECK(prior.own[0].std == 0.01);
}

TEST_CASE("A prior of zero width does not change") {
  const SharedPrior prior = prior_after({LearnedError{0.0, 0.0}, LearnedError{0.0, 0.0}},
                                        {{0.0, 0.0}, {0.0, 0.0}}, 0.001);
  CHECK(prior.own[0].std == 0.0);
  CHECK(prior.common_variance == 0.0);
}

TEST_CASE("With learned errors the filter converges faster and stays credible") {
  OdometryDrive before = a_drive(1);
  before.drive(20.0);
  const Learned learned = before.filter().learned();
  double with_rad2 = 0.0;
  double without_rad2 = 0.0;
  double nees = 0.0;
  double yaw_rate_nees = 0.0;
  int drives = 0;
  for (std::uint64_t seed = 11; seed < 19; ++seed, ++drives) {
    OdometryDrive with = a_drive(seed, learned);
    OdometryDrive without = a_drive(seed);
    const Odometry odometry = with.drive(0.6);
    without.drive(0.6);
    const Difference a = difference(with.filter());
    const Difference b = difference(without.filter());
    CHECK(a.std_rad < 0.7 * b.std_rad);
    with_rad2 += a.error_rad * a.error_rad;
    without_rad2 += b.error_rad * b.error_rad;
    nees += std::pow(a.error_rad / a.std_rad, 2);
    yaw_rate_nees += std::pow(odometry.twist.z(), 2) / odometry.twist_covariance(2, 2);
  }
  CAPTURE(with_rad2, without_rad2, nees / drives, yaw_rate_nees / drives);
  CHECK(with_rad2 < 0.5 * without_rad2);
  CHECK(nees / drives < 2.5);
  CHECK(yaw_rate_nees / drives < 2.5);
}

TEST_CASE("Over many restarts no prior counts twice: common errors stay as uncertain") {
  Learned learned;
  double first_std_rad = 0.0;
  for (std::uint64_t seed = 21; seed < 27; ++seed) {
    OdometryDrive drive = a_drive(seed, learned);
    drive.drive(8.0);
    learned = drive.filter().learned();
    const std::vector<int> states{state_layout::radar(0) + state_layout::kMountYaw,
                                  state_layout::radar(1) + state_layout::kMountYaw,
                                  state_layout::radar(2) + state_layout::kMountYaw};
    const Eigen::Matrix3d covariance = drive.filter().state().covariance()(states, states);
    const double common_std_rad = std::sqrt(covariance.sum()) / 3.0;
    first_std_rad = seed == 21 ? common_std_rad : first_std_rad;
    CHECK(common_std_rad > 0.9 * first_std_rad);
    CHECK(std::abs(difference(drive.filter()).error_rad) <
          3.0 * difference(drive.filter()).std_rad);
  }
}

TEST_CASE("A wrong learned error is corrected, or the radar is in doubt") {
  const double sigmas = GENERATE(5.0, -5.0);
  const std::size_t liar = GENERATE(0, 1);
  CAPTURE(sigmas, liar);
  OdometryDrive before = a_drive(2);
  before.drive(20.0);
  Learned learned = before.filter().learned();
  // 5 sigma of the file, and 5 sigma of the value taken over.
  const double lie_rad = sigmas * std::max(learned[liar]->mount_yaw_rad.std, 0.0075 / 4.0);
  learned[liar]->mount_yaw_rad.value += lie_rad;
  OdometryDrive drive = a_drive(31, learned);
  double worst = 0.0;
  bool is_left_out = false;
  for (int i = 0; i < 400; ++i) {
    const Odometry odometry = drive.next();
    is_left_out = is_left_out || odometry.left_out != 0;
    if (i > 200 && odometry.status == OdometryStatus::ok) {
      worst = std::max(worst,
                       std::abs(odometry.twist.z()) / std::sqrt(odometry.twist_covariance(2, 2)));
    }
  }
  const Difference end = difference(drive.filter());
  CAPTURE(end.error_rad, end.std_rad, is_left_out, worst);
  CHECK((is_left_out || std::abs(end.error_rad) < 4.0 * end.std_rad));
  CHECK(worst < 5.0);
}

TEST_CASE("What was learned of the mounts survives a long standstill") {
  OdometryDrive drive = a_drive(3);
  drive.drive(12.0);
  const Difference before = difference(drive.filter());
  REQUIRE(before.std_rad < 0.75 * difference(a_drive(3).filter()).std_rad);
  for (double speed_mps = 10.0; speed_mps > 0.0; speed_mps -= 0.1) {
    drive.set_motion(speed_mps, 0.0);
    drive.next();
  }
  drive.set_motion(0.0, 0.0);
  // A railway crossing.
  drive.drive(180.0);
  const Difference after = difference(drive.filter());
  CAPTURE(before.error_rad, before.std_rad, after.error_rad, after.std_rad);
  CHECK(std::abs(after.error_rad - before.error_rad) < 0.2 * before.std_rad);
  CHECK(after.std_rad < 1.1 * before.std_rad);
}

TEST_CASE(
    "What was learned of the mounts survives a restart, by a gap or by a clock that was set") {
  OdometryDrive drive = a_drive(4);
  drive.drive(12.0);
  const Difference before = difference(drive.filter());
  const bool is_set = GENERATE(false, true);
  if (is_set) {
    drive.filter().forget();
  } else {
    drive.pass(60'000'000);
  }
  CHECK(drive.next().status == OdometryStatus::initialising);
  const Difference after = difference(drive.filter());
  CHECK(std::abs(after.error_rad - before.error_rad) < 0.2 * before.std_rad);
  CHECK(after.std_rad < 1.1 * before.std_rad);
}

TEST_CASE("A radar in doubt keeps the value that was learned, with the width of the prior") {
  OdometryDrive drive = a_drive(5);
  drive.drive(12.0);
  const RadarReport before = drive.filter().report(0);
  drive.pass(OdometryDrive::kPeriodUs);
  drive.filter().update(0, drive.see(0), drive.stamp_us(), false);
  const RadarReport doubted = drive.filter().report(0);
  CHECK(doubted.mount_yaw_rad ==
        Approx(before.mount_yaw_rad).margin(0.1 * before.mount_yaw_std_rad));
  CHECK(doubted.mount_yaw_std_rad == Approx(OdometryOptions().mount_yaw_std_rad));
  // The others are as certain as before, and it learns again.
  CHECK(drive.filter().report(1).mount_yaw_std_rad < OdometryOptions().mount_yaw_std_rad);
  drive.drive(10.0);
  const Difference after = difference(drive.filter());
  CHECK(std::abs(after.error_rad) < 3.0 * after.std_rad);
  CHECK(after.std_rad < 0.75 * difference(a_drive(5).filter()).std_rad);
}

}  // namespace cremed
