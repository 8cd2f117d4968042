// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
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

const std::vector<Pose2> kMounts{{3.4, 0.0, 0.0}, {-0.6, 0.6, 3.05}, {-0.6, -0.6, -3.05}};

/// True yaw of the mounts minus the filter's: 1 sigma.
const std::vector<double> kYawErrorsRad{0.0075, -0.0060, 0.0030};

OdometryDrive a_drive(std::uint64_t seed, const Learned& learned = {}) {
  OdometryDrive drive(kMounts, seed, {}, learned);
  for (std::size_t i = 0; i < kMounts.size(); ++i) {
    drive.radar(i).mount.yaw_rad += kYawErrorsRad[i];
  }
  drive.set_motion(10.0, 0.0);
  return drive;
}

/// Of the front mount's yaw minus the mean of the rear ones', which slip cannot explain.
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

TEST_CASE("What all radars err by in common is as unknown at a restart as it was before") {
  const std::vector<LearnedError> unlearned(4, {0.0, 0.01});
  const SharedPrior prior = prior_after({LearnedError{0.004, 0.002}, LearnedError{0.006, 0.001},
                                         std::nullopt, LearnedError{0.011, 0.02}},
                                        unlearned, 0.001);
  // Without the mean; sigma includes possible changes, at least a quarter and at most the prior's.
  CHECK(prior.own[0].value == Approx(-0.003));
  CHECK(prior.own[1].value == Approx(-0.001));
  CHECK(prior.own[3].value == Approx(0.004));
  CHECK(prior.own[0].std == Approx(0.0025));
  CHECK(prior.own[1].std == Approx(0.0025));
  CHECK(prior.own[3].std == Approx(0.01));
  CHECK(prior.common_variance == Approx(0.01 * 0.01 / 3.0));
  // The new radar is unknown.
  CHECK_FALSE(prior.own[2].is_learned);
  CHECK(prior.own[2].value == 0.0);
  CHECK(prior.own[2].std == 0.01);
}

TEST_CASE("Differences are those to the weighted mean, with their own sigma") {
  // Both known except for the common part.
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

TEST_CASE("A sigma taken over is never smaller than that learned and what may change meanwhile") {
  const double learned_std = GENERATE(1e-5, 0.001, 0.003, 0.006, 0.01);
  const SharedPrior prior = prior_after({LearnedError{0.0, learned_std}, LearnedError{0.0, 0.001}},
                                        {{0.0, 0.01}, {0.0, 0.01}}, 0.001);
  CHECK(prior.own[0].std >= std::min(0.01, std::hypot(learned_std, 0.001)));
  CHECK(prior.own[0].std <= 0.01);
}

TEST_CASE("One radar alone has learned nothing that can be told from slip and speed") {
  const SharedPrior prior = prior_after({LearnedError{0.004, 0.001}}, {{0.0, 0.01}}, 0.001);
  CHECK_FALSE(prior.own[0].is_learned);
  CHECK(prior.own[0].value == 0.0);
  CHECK(prior.own[0].std == 0.01);
}

TEST_CASE("A prior of no width stays what it is") {
  const SharedPrior prior = prior_after({LearnedError{0.0, 0.0}, LearnedError{0.0, 0.0}},
                                        {{0.0, 0.0}, {0.0, 0.0}}, 0.001);
  CHECK(prior.own[0].std == 0.0);
  CHECK(prior.common_variance == 0.0);
}

TEST_CASE("With what a drive before learned the filter converges faster, and stays credible") {
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

TEST_CASE("Restart after restart nothing is counted twice: common errors stay as unknown") {
  Learned learned;
  double first_std_rad = 0.0;
  for (std::uint64_t seed = 21; seed < 27; ++seed) {
    OdometryDrive drive = a_drive(seed, learned);
    drive.drive(8.0);
    learned = drive.filter().learned();
    const std::vector<int> states{state_layout::radar(0), state_layout::radar(1),
                                  state_layout::radar(2)};
    const Eigen::Matrix3d covariance = drive.filter().state().covariance()(states, states);
    const double common_std_rad = std::sqrt(covariance.sum()) / 3.0;
    first_std_rad = seed == 21 ? common_std_rad : first_std_rad;
    CHECK(common_std_rad > 0.9 * first_std_rad);
    CHECK(std::abs(difference(drive.filter()).error_rad) <
          3.0 * difference(drive.filter()).std_rad);
  }
}

TEST_CASE("A lie in what was learned is overcome, or the radar is in doubt") {
  const double sigmas = GENERATE(5.0, -5.0);
  const std::size_t liar = GENERATE(0, 1);
  CAPTURE(sigmas, liar);
  OdometryDrive before = a_drive(2);
  before.drive(20.0);
  Learned learned = before.filter().learned();
  // Five of the sigma in the file, and of the one that is used.
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

}  // namespace cremed
