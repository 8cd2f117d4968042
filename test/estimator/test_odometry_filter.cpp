// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "cremed/estimator/fusion/state/pose_chain.hpp"
#include "cremed/estimator/scan/squared.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/odometry_drive.hpp"

namespace cremed {
namespace {

using simulation::kFront;
using simulation::kRearLeft;
using simulation::kRearRight;
using simulation::OdometryDrive;

/// Largest error of speed and yaw rate in standard deviations, if the status is ok.
double twist_error(const Odometry& odometry, const OdometryDrive& drive) {
  const Eigen::Vector3d error =
      odometry.twist - Eigen::Vector3d(drive.speed_mps(), 0.0, drive.yaw_rate_radps());
  return odometry.is_usable()
             ? std::max(std::abs(error.x()) / std::sqrt(odometry.twist_covariance(0, 0)),
                        std::abs(error.z()) / std::sqrt(odometry.twist_covariance(2, 2)))
             : 0.0;
}

TEST_CASE(
    "the pose since the anchor is credible straight on and in a turn, with one radar or three") {
  const auto mounts =
      GENERATE(std::vector<Pose2>{kFront}, std::vector<Pose2>{kFront, kRearLeft, kRearRight});
  const double yaw_rate_radps = GENERATE(0.0, 0.3);
  OdometryDrive drive(mounts, 1);
  drive.set_motion(9.0, yaw_rate_radps);
  std::map<std::int64_t, Eigen::Vector3d> true_poses;
  int good = 0;
  double most = 0.0;
  for (int i = 0; i < 150; ++i) {
    const Odometry odometry = drive.next();
    true_poses[drive.stamp_us()] = drive.pose();
    REQUIRE(odometry.utime_us == drive.stamp_us());
    good += odometry.is_usable() ? 1 : 0;
    if (odometry.is_usable() && true_poses.count(odometry.utime_anchor_us) != 0 &&
        odometry.utime_anchor_us != odometry.utime_us) {
      const Eigen::Vector3d error =
          odometry.pose - relative_pose(true_poses[odometry.utime_anchor_us], drive.pose());
      most = std::max(most, numeric::normalised_error(error, odometry.covariance, 3) / 3.0);
      CHECK(std::sqrt(odometry.covariance.topLeftCorner<2, 2>().trace()) < 0.5);
    }
    CHECK(twist_error(odometry, drive) < 5.0);
  }
  // The start lasts until positions confirm the speed of a single radar.
  CHECK(good > 115);
  CHECK(most < 8.0);
  CHECK(most > 0.01);
}

TEST_CASE("motions between outputs compose to the pose since the start") {
  OdometryDrive drive({kFront, kRearLeft}, 2);
  drive.set_motion(9.0, 0.2);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::int64_t end_us = 0;
  for (int i = 0; i < 200; ++i) {
    const Odometry odometry = drive.next();
    if (!odometry.is_new) {
      continue;
    }
    CHECK((end_us == 0 || odometry.utime_before_us == end_us));
    end_us = odometry.utime_us;
    sum = composed_pose(sum, odometry.motion);
    CHECK((sum - odometry.odom_pose).norm() < 1e-9);
    CHECK(odometry.odom_covariance.trace() >= 0.999 * odometry.covariance.trace());
    CHECK(odometry.motion_covariance.diagonal().minCoeff() > 0.0);
  }
}

/// A motion with errors that last: scale, slip and yaw per metre.
Eigen::Vector3d with_errors(const Eigen::Vector3d& motion, const Eigen::Vector3d& errors) {
  const double turn_rad = errors.z() * motion.x();
  const Eigen::Rotation2Dd turn(errors.y() + 0.5 * turn_rad);
  Eigen::Vector3d result;
  result << (1.0 + errors.x()) * (turn * motion.head<2>()), motion.z() + turn_rad;
  return result;
}

/// Covariance of the pose of `odometry` since the start, if that of its anchor is independent.
Eigen::Matrix3d composed_covariance(const Eigen::Vector3d& anchor, const Eigen::Matrix3d& of_anchor,
                                    const Odometry& odometry) {
  const auto jacobian = composed_pose_jacobian(anchor, odometry.pose);
  const Eigen::Matrix3d by_anchor = jacobian.leftCols<3>();
  const Eigen::Matrix3d by_pose = jacobian.rightCols<3>();
  return by_anchor * of_anchor * by_anchor.transpose() +
         by_pose * odometry.covariance * by_pose.transpose();
}

TEST_CASE(
    "the pose since the start is as uncertain as chained anchors, by errors that last, and by its "
    "difference from anchors") {
  OdometryDrive drive({kFront, kRearLeft}, 2);
  drive.set_motion(9.0, 0.2);
  constexpr double kStep = 1e-5;
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();
  Eigen::Matrix3d of_anchor = Eigen::Matrix3d::Zero();
  std::array<Eigen::Vector3d, 3> moved;  // The anchor with each of the errors.
  moved.fill(anchor);
  const auto moved_by = [&](std::size_t error, const Eigen::Vector3d& motion) {
    return composed_pose(
        moved[error], with_errors(motion, kStep * Eigen::Vector3d::Unit(static_cast<int>(error))));
  };
  const LastingErrors lasting;
  const std::array<double, 3> std{lasting.scale_std, lasting.slip_std_rad,
                                  lasting.yaw_per_metre_std};
  Odometry last = drive.next();
  double most_m = 0.0;
  for (int i = 0; i < 200; ++i) {
    const Odometry odometry = drive.next();
    if (odometry.utime_anchor_us != last.utime_anchor_us) {
      of_anchor = composed_covariance(anchor, of_anchor, last);
      anchor = composed_pose(anchor, last.pose);
      for (std::size_t error = 0; error < moved.size(); ++error) {
        moved[error] = moved_by(error, last.pose);
      }
    }
    last = odometry;
    Eigen::Matrix3d expected = composed_covariance(anchor, of_anchor, odometry);
    const Eigen::Vector3d by_anchors = composed_pose(anchor, odometry.pose);
    for (std::size_t error = 0; error < moved.size(); ++error) {
      const Eigen::Vector3d by_error =
          std[error] / kStep * (moved_by(error, odometry.pose) - by_anchors);
      expected += by_error * by_error.transpose();
    }
    const Eigen::Vector3d drift = odometry.odom_pose - by_anchors;
    const Eigen::Vector3d std_by_anchors = expected.diagonal().cwiseSqrt();
    const Eigen::Matrix3d limit =
        1e-3 * std_by_anchors * std_by_anchors.transpose() + Eigen::Matrix3d::Constant(1e-12);
    const Eigen::Matrix3d left = odometry.odom_covariance - expected - drift * drift.transpose();
    CHECK((left.cwiseAbs().array() < limit.array()).all());
    most_m = std::max(most_m, drift.head<2>().norm());
  }
  CHECK(most_m > 0.05);
}

TEST_CASE("the output at a new anchor's time still refers to the old one") {
  OdometryDrive drive({kFront}, 3);
  Odometry before = drive.next();
  int renewed = 0;
  for (int i = 0; i < 100; ++i) {
    const Odometry odometry = drive.next();
    if (odometry.utime_anchor_us != before.utime_anchor_us) {
      CHECK(odometry.utime_anchor_us == before.utime_us);
      if (renewed == 0) {  // The start is over.
        CHECK(before.status == OdometryStatus::initialising);
        CHECK(odometry.status == OdometryStatus::ok);
      } else {
        CHECK(static_cast<double>(before.utime_us - before.utime_anchor_us) * 1e-6 ==
              Approx(OdometryOptions().anchor_period_s).margin(0.1));
      }
      ++renewed;
    }
    before = odometry;
  }
  CHECK(renewed == 4);
}

TEST_CASE("standing still is detected, and so is driving off") {
  OdometryDrive drive({kFront, kRearLeft}, 4);
  drive.set_motion(0.0, 0.0);
  CHECK(drive.drive(1.5).status == OdometryStatus::standing_still);
  for (int i = 0; i < 100; ++i) {
    CHECK(drive.next().status == OdometryStatus::standing_still);
  }
  for (double speed_mps = 0.0; speed_mps < 6.0; speed_mps += 0.1) {
    drive.set_motion(speed_mps, 0.0);
    CHECK(twist_error(drive.next(), drive) < 5.0);
  }
  CHECK(drive.drive(0.5).status == OdometryStatus::ok);
}

/// Standard deviation of the speed after a second at it.
double speed_std_mps(OdometryDrive& drive, double speed_mps) {
  while (std::abs(drive.speed_mps() - speed_mps) > 1e-9) {
    const double change_mps = std::clamp(speed_mps - drive.speed_mps(), -0.05, 0.05);
    drive.set_motion(drive.speed_mps() + change_mps, 0.0);
    drive.next();
  }
  return std::sqrt(drive.drive(1.0).twist_covariance(0, 0));
}

TEST_CASE("a creeping vehicle's speed is as uncertain as the rounding of Doppler makes it") {
  OdometryDrive drive({kFront, kRearLeft, kRearRight}, 41);
  REQUIRE(drive.drive(2.0).status == OdometryStatus::ok);
  CHECK(speed_std_mps(drive, 3.0) < 0.06);
  CHECK(speed_std_mps(drive, 0.4) == Approx(kRoundingStdMps).epsilon(0.2));
  CHECK(speed_std_mps(drive, 0.0) < 0.03);
}

TEST_CASE(
    "in a creeping jam the speed is as uncertain as its cars make it, and no radar at fault") {
  OdometryDrive drive({kFront, kRearLeft, kRearRight}, 43);
  REQUIRE(drive.drive(2.0).status == OdometryStatus::ok);
  CHECK(speed_std_mps(drive, 0.5) < 0.1);
  for (int i = 0; i < 200; ++i) {
    const double traffic_mps = std::min(0.5, 0.01 * i);  // 0.4 m/s^2.
    drive.radar(0).traffic_mps = drive.radar(1).traffic_mps = traffic_mps;
    drive.radar(2).traffic_mps = 0.6 * traffic_mps;
    const Odometry odometry = drive.next();
    CHECK(odometry.left_out == 0);
    const double std_mps = std::sqrt(odometry.twist_covariance(0, 0));
    CHECK(std::abs(odometry.twist.x() - drive.speed_mps()) < 3.0 * std_mps);
    CHECK(std_mps < 0.6);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    drive.radar(i).traffic_mps = 0.0;
  }
  CHECK(std::sqrt(drive.drive(10.0).twist_covariance(0, 0)) < 0.1);
}

TEST_CASE("a skid is followed, with all radars, and one radar that is turned is none") {
  OdometryDrive drive({kFront, kRearLeft, kRearRight}, 45);
  REQUIRE(drive.drive(3.0).status == OdometryStatus::ok);
  const double usual_std_mps = std::sqrt(drive.next().twist_covariance(1, 1));
  SECTION("skid") {
    int beyond = 0;
    for (int i = 0; i < 200; ++i) {
      // Up to 1.5 m/s within 1 s, and back.
      drive.set_motion(8.0, 0.0, 0.75 - 0.75 * std::cos(0.025 * i * std::numbers::pi));
      const Odometry odometry = drive.next();
      CHECK(odometry.left_out == 0);
      const double error_mps = std::abs(odometry.twist.y() - drive.side_mps());
      CHECK(error_mps < 0.3);
      beyond += error_mps > 5.0 * std::sqrt(odometry.twist_covariance(1, 1)) ? 1 : 0;
    }
    CHECK(beyond <= 4);  // 2 %, while it begins.
    CHECK(drive.drive(2.0).status == OdometryStatus::ok);
    CHECK(std::abs(drive.filter().report(0).mount_yaw_rad) < 0.01);
  }
  SECTION("silence within it") {
    for (int i = 0; i < 20; ++i) {
      drive.set_motion(8.0, 0.0, 0.05 * i);
      drive.next();
    }
    drive.pass(2'500'000);
    drive.set_motion(8.0, 0.0);
    const Odometry odometry = drive.drive(1.0);
    CHECK(odometry.status == OdometryStatus::ok);
    CHECK(std::abs(odometry.twist.y()) < 5.0 * std::sqrt(odometry.twist_covariance(1, 1)));
  }
  SECTION("turned") {
    drive.radar(1).mount.yaw_rad += numeric::radians(8.0);
    for (int i = 0; i < 100; ++i) {
      CHECK(std::sqrt(drive.next().twist_covariance(1, 1)) < 1.5 * usual_std_mps);
    }
  }
}

TEST_CASE("a faulty radar is left out and reported, and used again when it agrees for seconds") {
  OdometryDrive drive({kFront, kRearLeft, kRearRight}, 5);
  REQUIRE(drive.drive(2.0).status == OdometryStatus::ok);
  drive.radar(0).world_mps = GENERATE(2.0, 8.0);
  for (int i = 0; i < 100; ++i) {
    const Odometry odometry = drive.next();
    CHECK(odometry.is_usable());
    CHECK(twist_error(odometry, drive) < 5.0);
    if (i > 20) {
      CHECK(odometry.left_out == 1U);
      CHECK((odometry.radars & 1U) == 0U);
    }
  }
  drive.radar(0).world_mps = 0.0;
  CHECK(drive.drive(1.0).left_out == 1U);
  CHECK(drive.drive(6.0).left_out == 0U);
  std::uint32_t radars = 0;
  for (int i = 0; i < 3; ++i) {
    radars |= drive.next().radars;
  }
  CHECK(radars == 7U);
}

/// Largest NEES of the pose since the anchor and of the velocity in usable outputs, and their
/// share.
struct Judged {
  double largest_nees = 0.0;
  double usable_share = 0.0;
};

Judged judge(OdometryDrive& drive, double time_s) {
  Judged judged;
  std::map<std::int64_t, Eigen::Vector3d> poses;
  const std::int64_t end_us = drive.stamp_us() + std::llround(1e6 * time_s);
  double outputs = 0.0;
  double usable = 0.0;
  while (drive.stamp_us() < end_us) {
    const Odometry odometry = drive.next();
    poses[drive.stamp_us()] = drive.pose();
    outputs += 1.0;
    if (!odometry.is_usable()) continue;
    usable += 1.0;
    const Eigen::Vector3d of_twist =
        odometry.twist - Eigen::Vector3d(drive.speed_mps(), 0.0, drive.yaw_rate_radps());
    judged.largest_nees =
        std::max(judged.largest_nees,
                 numeric::normalised_error(of_twist, odometry.twist_covariance, 3) / 3.0);
    const auto anchor = poses.find(odometry.utime_anchor_us);
    if (anchor != poses.end() && anchor->first != odometry.utime_us) {
      const Eigen::Vector3d error = odometry.pose - relative_pose(anchor->second, drive.pose());
      judged.largest_nees = std::max(
          judged.largest_nees, numeric::normalised_error(error, odometry.covariance, 3) / 3.0);
    }
  }
  judged.usable_share = usable / outputs;
  return judged;
}

constexpr double kCredibleNees = 8.0;

TEST_CASE("the mount of a lone radar that looks elsewhere is learned and named") {
  const double turned_deg = GENERATE(3.0, -6.0);
  OdometryDrive drive({kFront}, 23);
  CAPTURE(turned_deg);
  SECTION("from the start") {
    drive.radar(0).mount.yaw_rad += numeric::radians(turned_deg);
    const Judged judged = judge(drive, 10.0);
    CHECK(judged.largest_nees < kCredibleNees);
    CHECK(judged.usable_share > 0.6);
  }
  SECTION("while driving") {
    drive.drive(3.0);
    CHECK(drive.filter().report(0).cause.kind == FaultKind::unknown);
    drive.radar(0).mount.yaw_rad += numeric::radians(turned_deg);
    drive.drive(1.0);  // In which a turn by three degrees is not seen yet.
    const Judged judged = judge(drive, 10.0);
    CHECK(judged.largest_nees < kCredibleNees);
    CHECK(judged.usable_share > 0.9);
  }
  CHECK(drive.next().status == OdometryStatus::ok);
  const RadarReport report = drive.filter().report(0);
  CHECK_FALSE(report.is_left_out);
  REQUIRE(report.cause.kind == FaultKind::mount_yaw);
  CHECK(report.cause.value == Approx(numeric::radians(turned_deg)).margin(numeric::radians(0.8)));
}

TEST_CASE("the learned mount of a lone radar stays learned for minutes") {
  OdometryDrive drive({kFront}, 26);
  drive.set_motion(6.0, 0.2);  // Around among the points.
  drive.radar(0).mount.yaw_rad += 0.1;
  drive.drive(5.0);
  for (int minute = 0; minute < 5; ++minute) {
    const Judged judged = judge(drive, 60.0);
    CAPTURE(minute);
    CHECK(judged.largest_nees < kCredibleNees);
    CHECK(judged.usable_share == 1.0);
    CHECK(drive.filter().report(0).cause.kind == FaultKind::mount_yaw);
    CHECK(drive.filter().report(0).mount_yaw_rad == Approx(0.1).margin(0.015));
  }
  CHECK_FALSE(drive.filter().learned().at(0));
}

TEST_CASE("mounts that are all turned alike are learned and named") {
  const auto mounts = GENERATE(std::vector<Pose2>{kFront, kRearLeft},
                               std::vector<Pose2>{kFront, kRearLeft, kRearRight});
  const double turned_deg = GENERATE(-5.0, -3.0, 3.0, 5.0);
  const double speed_mps = GENERATE(8.0, -4.0);
  CAPTURE(mounts.size(), turned_deg, speed_mps);
  OdometryDrive drive(mounts, 27);
  drive.set_motion(speed_mps, 0.0);
  for (std::size_t i = 0; i < mounts.size(); ++i) {
    drive.radar(i).mount.yaw_rad += numeric::radians(turned_deg);
  }
  CHECK(judge(drive, 3.0).largest_nees < kCredibleNees);
  const Judged judged = judge(drive, 8.0);
  CHECK(judged.largest_nees < kCredibleNees);
  CHECK(judged.usable_share > 0.95);
  for (std::size_t i = 0; i < mounts.size(); ++i) {
    const RadarReport report = drive.filter().report(i);
    CHECK_FALSE(report.is_left_out);
    // The vehicle may slip by 0.43 degrees (1 sigma) as well.
    CHECK(report.mount_yaw_rad ==
          Approx(numeric::radians(turned_deg)).margin(numeric::radians(1.3)));
    CHECK(report.cause.kind == FaultKind::mount_yaw);
  }
}

TEST_CASE("a Doppler scale that all radars share is learned and named until it is right again") {
  const bool is_pair = GENERATE(true, false);
  const std::vector<Pose2> mounts = is_pair ? std::vector<Pose2>{kFront, kRearLeft}
                                            : std::vector<Pose2>{kFront, kRearLeft, kRearRight};
  // The map of a pair, without its own checks, does not show an error of a tenth at speed.
  const double scale = GENERATE_COPY(0.95, 1.06, is_pair ? 0.94 : 0.9, is_pair ? 1.05 : 1.12);
  const double speed_mps = GENERATE(10.0, -5.0);
  CAPTURE(mounts.size(), scale, speed_mps);
  OdometryDrive drive(mounts, 30);
  drive.set_motion(speed_mps, 0.05);
  const auto scale_all = [&](double factor, double for_s) {
    for (std::size_t i = 0; i < mounts.size(); ++i) {
      drive.radar(i).doppler_scale = factor;
    }
    drive.drive(for_s);  // Until it is found.
  };
  scale_all(scale, 1.5);
  const Judged judged = judge(drive, 10.0);
  CHECK(judged.largest_nees < kCredibleNees);
  CHECK(judged.usable_share > 0.95);
  for (std::size_t i = 0; i < mounts.size(); ++i) {
    const RadarReport report = drive.filter().report(i);
    CHECK_FALSE(report.is_left_out);
    REQUIRE(report.cause.kind == FaultKind::scale);
    CHECK(report.cause.value == Approx(1.0 / scale).margin(0.01));
  }
  scale_all(1.0, 4.0);
  const Judged back = judge(drive, 5.0);
  CHECK(back.largest_nees < kCredibleNees);
  CHECK(back.usable_share > 0.95);
  CHECK(drive.filter().report(0).cause.kind == FaultKind::unknown);
}

TEST_CASE("a radar at fault is not turned with the others") {
  OdometryDrive drive({kFront, kRearLeft, kRearRight}, 29);
  drive.radar(2).world_mps = 3.0;
  REQUIRE(drive.drive(3.0).left_out == 4U);
  for (std::size_t i = 0; i < 2; ++i) {
    drive.radar(i).mount.yaw_rad += numeric::radians(1.5);
  }
  const Judged judged = judge(drive, 10.0);
  CHECK(judged.largest_nees < kCredibleNees);
  CHECK(judged.usable_share > 0.95);
  CHECK(drive.filter().report(0).mount_yaw_rad == Approx(0.026).margin(0.016));
  CHECK(std::abs(drive.filter().report(2).mount_yaw_rad) < 0.005);
}

TEST_CASE("mounts that are all turned too far to be learned are named, and none is used") {
  OdometryDrive drive({kFront, kRearLeft, kRearRight}, 28);
  for (std::size_t i = 0; i < 3; ++i) {
    drive.radar(i).mount.yaw_rad += numeric::radians(9.0);
  }
  CHECK(judge(drive, 6.0).usable_share == 0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const FaultCause cause = drive.filter().report(i).cause;
    CHECK(cause.kind == FaultKind::mount_yaw);
    CHECK(cause.value == Approx(numeric::radians(9.0)).margin(numeric::radians(1.5)));
  }
}

TEST_CASE("a lone radar that turns too far to be learned is left out until it turns back") {
  OdometryDrive drive({kFront}, 24);
  REQUIRE(drive.drive(3.0).status == OdometryStatus::ok);
  drive.radar(0).mount.yaw_rad += numeric::radians(20.0);
  const Judged turned = judge(drive, 4.0);
  CHECK(turned.largest_nees < kCredibleNees);
  CHECK(turned.usable_share < 0.2);
  const RadarReport report = drive.filter().report(0);
  CHECK(report.is_left_out);
  CHECK(report.cause.kind == FaultKind::mount_yaw);
  CHECK(report.cause.value == Approx(numeric::radians(20.0)).margin(numeric::radians(4.0)));
  drive.radar(0).mount.yaw_rad -= numeric::radians(20.0);
  const Judged back = judge(drive, 8.0);
  CHECK(back.largest_nees < kCredibleNees);
  CHECK(back.usable_share > 0.5);
  CHECK(drive.next().status == OdometryStatus::ok);
  CHECK(drive.filter().report(0).cause.kind == FaultKind::unknown);
}

TEST_CASE("a radar whose mount says that it looks aside does not turn the vehicle about itself") {
  const double side = GENERATE(1.0, -1.0);
  CAPTURE(side);
  OdometryDrive drive({{kFront.x_m, 0.0, side * 1.56}}, 25);
  drive.radar(0).mount.yaw_rad = 0.0;
  drive.set_motion(2.0, 0.1);
  CHECK(judge(drive, 8.0).usable_share == 0.0);
  const RadarReport report = drive.filter().report(0);
  CHECK(report.is_left_out);
  CHECK(report.cause.kind == FaultKind::mount_yaw);
  CHECK(report.cause.value == Approx(-side * 1.56).margin(0.2));
}

TEST_CASE("radars that join a lone one whose mount was learned agree with it, or judge it") {
  OdometryDrive drive({kFront, kRearLeft, kRearRight}, 25);
  const double turned_deg = GENERATE(6.0, 20.0);
  CAPTURE(turned_deg);
  drive.radar(1).is_silent = drive.radar(2).is_silent = true;
  drive.drive(3.0);
  drive.radar(0).mount.yaw_rad += numeric::radians(turned_deg);
  drive.drive(3.0);
  REQUIRE(drive.filter().report(0).cause.kind == FaultKind::mount_yaw);
  drive.radar(1).is_silent = drive.radar(2).is_silent = false;
  const Judged judged = judge(drive, 10.0);
  CHECK(judged.largest_nees < kCredibleNees);
  CHECK(judged.usable_share > 0.7);
  const Odometry odometry = drive.next();
  CHECK(odometry.status == OdometryStatus::ok);
  CHECK(odometry.left_out == (turned_deg > 10.0 ? 1U : 0U));
}

TEST_CASE("of four corner radars at 45 degrees the faulty one is left out") {
  constexpr double kCorner = 0.25 * std::numbers::pi;
  const std::vector<Pose2> corners{{3.5, 0.8, kCorner},
                                   {3.5, -0.8, -kCorner},
                                   {-0.8, 0.8, 3.0 * kCorner},
                                   {-0.8, -0.8, -3.0 * kCorner}};
  OdometryDrive drive(corners, 5);
  REQUIRE(drive.drive(2.0).status == OdometryStatus::ok);
  CHECK(drive.drive(3.0).left_out == 0U);
  SECTION("its Doppler too large") { drive.radar(0).doppler_scale = 1.15; }
  SECTION("its mount turned") { drive.radar(0).mount.yaw_rad += 0.15; }
  drive.drive(2.0);
  for (int i = 0; i < 60; ++i) {
    const Odometry odometry = drive.next();
    CHECK(odometry.left_out == 1U);
    CHECK(odometry.is_usable());
    CHECK(twist_error(odometry, drive) < 5.0);
  }
}

TEST_CASE("a majority of radars overrules the one that the filter followed") {
  OdometryDrive drive({kFront, kRearLeft, kRearRight}, 6);
  // The faulty radar is alone at first.
  drive.radar(0).world_mps = 5.0;
  drive.radar(1).is_silent = true;
  drive.radar(2).is_silent = true;
  drive.drive(2.0);
  drive.radar(1).is_silent = false;
  drive.radar(2).is_silent = false;
  drive.drive(1.0);
  for (int i = 0; i < 60; ++i) {
    const Odometry odometry = drive.next();
    CHECK(odometry.is_usable());
    CHECK(twist_error(odometry, drive) < 5.0);
    CHECK(odometry.left_out == 1U);
  }
}

TEST_CASE(
    "of two radars that contradict each other that is trusted whose positions agree with it") {
  OdometryDrive drive({kFront, kRearLeft}, 7);
  const std::size_t faulty = GENERATE(std::size_t{0}, std::size_t{1});
  drive.radar(faulty).world_mps = 4.0;
  for (int i = 0; i < 100; ++i) {
    const Odometry odometry = drive.next();
    if (i > 30) {
      CHECK((odometry.left_out >> faulty & 1U) != 0);
      CHECK((odometry.is_usable() ? twist_error(odometry, drive) : 0.0) < 5.0);
    }
  }
  drive.radar(faulty).world_mps = 0.0;
  drive.drive(6.0);
  CHECK(drive.next().is_usable());
}

TEST_CASE("vehicles on both sides do not outvote the only radar that looks ahead") {
  const double passing_mps = GENERATE(2.0, 4.0);
  OdometryDrive drive({kFront, {2.4, 0.8, 1.56}, {2.4, -0.8, -1.56}}, 6);
  REQUIRE(drive.drive(2.0).status == OdometryStatus::ok);
  drive.radar(1).world_mps = drive.radar(2).world_mps = passing_mps;
  int good = 0;
  for (int i = 0; i < 180; ++i) {
    const Odometry odometry = drive.next();
    good += odometry.is_usable() ? 1 : 0;
    CHECK((odometry.is_usable() ? twist_error(odometry, drive) : 0.0) < 5.0);
  }
  // 4 m/s on both sides are more than one radar tells of itself: ambiguous.
  CHECK(good > (passing_mps < 3.0 ? 170 : 30));
}

TEST_CASE("a lone radar that looks sideways starts on the road, not on what may be a vehicle") {
  const Pose2 left{2.4, 0.8, 1.56};
  const Pose2 right{2.4, -0.8, -1.56};
  struct Row {
    std::string what;
    std::vector<Pose2> mounts;
    int along;  ///< Number of targets that are seen less than 60 degrees off the way.
    bool move_along;
    bool starts;
  };
  const std::vector<Row> rows = {
      {"a vehicle beside, and the road abeam", {left}, 3, true, false},
      {"the road, of which a vehicle would look the same", {left}, 3, false, false},
      {"the road", {left}, 100, false, true},
      {"the road, on both sides", {left, right}, 3, false, true},
  };
  for (const Row& row : rows) {
    CAPTURE(row.what);
    OdometryDrive drive(row.mounts, 6);
    Odometry odometry;
    int good = 0;
    for (std::size_t i = 0; i < 80; ++i) {
      drive.pass(OdometryDrive::kPeriodUs / 2);
      const std::size_t radar = i % row.mounts.size();
      TargetSet targets;
      int along = 0;
      for (Target target : drive.see(radar)) {
        const bool is_along = std::abs(target.cos_bearing) > 0.5;
        if (is_along && row.move_along) {
          target.doppler_mps = 0.0;
        }
        if (!is_along || along < row.along) {
          targets.add(target);
        }
        along += is_along ? 1 : 0;
      }
      odometry = drive.filter().update(radar, targets, drive.stamp_us());
      good += odometry.is_usable() ? 1 : 0;
      CHECK(twist_error(odometry, drive) < 5.0);
    }
    CHECK((good > 40) == row.starts);
    CHECK((good > 0) == row.starts);
    CHECK((odometry.status == OdometryStatus::ambiguous) != row.starts);
  }
}

TEST_CASE("with a rate a message at each anchor's time refers to the anchor before") {
  OdometryOptions options;
  options.rate_hz = 50;
  OdometryDrive drive({kFront, kRearLeft, kRearRight}, 5, options);
  std::vector<Odometry> predictions;
  for (int i = 0; i < 300; ++i) {
    drive.radar(0).world_mps = i > 100 ? 3.0 : 0.0;  // A radar is found at fault.
    drive.next();
    while (const auto odometry = drive.filter().predict_next(drive.stamp_us())) {
      predictions.push_back(*odometry);
    }
  }
  int anchors = 0;
  for (std::size_t i = 1; i < predictions.size(); ++i) {
    if (predictions[i].utime_anchor_us != predictions[i - 1].utime_anchor_us) {
      CHECK(predictions[i].utime_anchor_us == predictions[i - 1].utime_us);
      ++anchors;
    }
  }
  CHECK(anchors > 3);
}

TEST_CASE("a single radar whose velocity jumps is not followed at once") {
  OdometryDrive drive({kFront}, 8);
  REQUIRE(drive.drive(2.0).status == OdometryStatus::ok);
  drive.radar(0).world_mps = 8.0;  // It drives behind a large vehicle.
  double variance = 0.0;
  for (int i = 0; i < 12; ++i) {
    const Odometry odometry = drive.next();
    CHECK(twist_error(odometry, drive) < 5.0);
    CHECK(odometry.twist.x() == Approx(8.0).margin(0.5));
    CHECK(odometry.twist_covariance(0, 0) > variance);
    variance = odometry.twist_covariance(0, 0);
  }
  CHECK(drive.next().status == OdometryStatus::ambiguous);
  drive.radar(0).world_mps = 0.0;
  CHECK(drive.drive(1.0).is_usable());
}

TEST_CASE("a step that no vehicle can make is not followed by a lone radar as hard braking") {
  OdometryDrive drive({kFront}, 8);
  drive.set_motion(22.0, 0.0);
  REQUIRE(drive.drive(3.0).status == OdometryStatus::ok);
  drive.radar(0).world_mps = GENERATE(2.0, 3.0, -3.0);
  for (int i = 0; i < 6; ++i) {
    CHECK(drive.next().twist.x() == Approx(22.0).margin(0.5));
  }
}

TEST_CASE("hard braking is followed by the only radar that looks ahead") {
  const std::vector<Pose2> alone{kFront};
  const std::vector<Pose2> with_sides{kFront, {2.4, 0.9, 1.57}, {2.4, -0.9, -1.57}};
  const auto& mounts = GENERATE_REF(alone, with_sides);
  OdometryDrive drive(mounts, 8);
  drive.set_motion(22.0, 0.0);
  REQUIRE(drive.drive(3.0).status == OdometryStatus::ok);
  const std::int64_t from_us = drive.stamp_us();
  while (drive.speed_mps() > 0.0) {
    const Odometry odometry = drive.next();
    CHECK(odometry.is_usable());
    CHECK(twist_error(odometry, drive) < 5.0);
    drive.set_motion(
        std::max(0.0, 22.0 - 9.0 * 1e-6 * static_cast<double>(drive.stamp_us() - from_us)), 0.0);
  }
}

TEST_CASE("a U-turn at full lock is no fault of a lone radar") {
  const double yaw_rate_radps = GENERATE(0.6, 0.85, 1.0);
  OdometryDrive drive({kFront}, 1);
  drive.set_motion(3.5, 0.0);
  drive.drive(4.0);
  for (double part = 0.0; part < 1.0; part += 0.05) {
    drive.set_motion(3.5, part * yaw_rate_radps);
    drive.next();
  }
  for (int i = 0; i < 80; ++i) {
    const Odometry odometry = drive.next();
    CAPTURE(yaw_rate_radps, i, to_string(odometry.status));
    CHECK(odometry.is_usable());
    CHECK_FALSE(drive.filter().is_fault_unknown());
  }
}

TEST_CASE("a start amid which the believed radars fall silent does not silence the one left") {
  constexpr std::size_t kLeft = 0;
  OdometryDrive drive({kFront, {3.4, 0.4, 0.0}, kRearLeft}, 3);
  drive.set_motion(6.0, 0.0);
  drive.drive(4.0);
  drive.radar(kLeft).doppler_scale = 0.7;
  REQUIRE((drive.drive(3.0).left_out & 1U) == 1U);
  const auto accelerate = [&](double by_mps2) {
    drive.set_motion(std::clamp(drive.speed_mps() + 0.025 * by_mps2, 0.0, 6.0), 0.0);
    return drive.next();
  };
  while (drive.speed_mps() > 0.0) accelerate(-2.0);
  REQUIRE(drive.drive(3.0).status == OdometryStatus::standing_still);
  drive.radar(kLeft).doppler_scale = 1.0;
  for (int i = 0; i < 400 && !drive.filter().is_start_in_doubt(); ++i) accelerate(0.5);
  REQUIRE(drive.filter().is_start_in_doubt());
  drive.radar(1).is_silent = drive.radar(2).is_silent = true;
  for (int i = 0; i < 300; ++i) accelerate(0.5);
  CHECK(drive.next().is_usable());
}

TEST_CASE("a step of the only radar that no vehicle can make is not followed, but its end is") {
  const double step_mps = GENERATE(-5.0, 4.0, 8.0);
  CAPTURE(step_mps);
  OdometryDrive drive({GENERATE(kFront, kRearLeft)}, 8);
  REQUIRE(drive.drive(4.0).status == OdometryStatus::ok);
  drive.radar(0).world_mps = step_mps;
  for (int i = 0; i < 80; ++i) {
    const Odometry odometry = drive.next();
    CAPTURE(i, to_string(odometry.status));
    CHECK((!odometry.is_usable() || twist_error(odometry, drive) < 5.0));
  }
  CHECK_FALSE(drive.next().is_usable());
  drive.radar(0).world_mps = 0.0;
  const Odometry after = drive.drive(2.0);
  CHECK(after.is_usable());
  CHECK(twist_error(after, drive) < 5.0);
}

TEST_CASE("a jump of the only radar is not believed before its own check knows its speed") {
  const double jump_mps = GENERATE(-1.1, 1.1);  // Hard braking may change as much between scans.
  CAPTURE(jump_mps);
  OdometryDrive drive({GENERATE(kFront, kRearLeft)}, 8);
  REQUIRE(drive.drive(GENERATE(1.0, 4.0)).status == OdometryStatus::ok);
  drive.radar(0).world_mps = jump_mps;
  drive.drive(2.0 * 0.075);  // It is seen with the next scan.
  for (int i = 0; i < 80; ++i) {
    drive.filter().compare(0, EgoMotion(), true, true);
    const Odometry odometry = drive.next();
    CAPTURE(i, to_string(odometry.status));
    CHECK((!odometry.is_usable() || twist_error(odometry, drive) < 5.0));
  }
  CHECK_FALSE(drive.next().is_usable());
  drive.radar(0).world_mps = 0.0;
  drive.filter().compare(0, EgoMotion(), true, false);
  const Odometry after = drive.drive(2.0);
  CHECK(after.is_usable());
  CHECK(twist_error(after, drive) < 5.0);
}

TEST_CASE("a jump of the only radar that ends again leaves the odometry right") {
  const double jump_mps = GENERATE(-1.1, 1.1);
  const int scans = GENERATE(3, 6, 10);
  CAPTURE(jump_mps, scans);
  OdometryDrive drive({kFront}, 8);
  REQUIRE(drive.drive(4.0).status == OdometryStatus::ok);
  drive.radar(0).world_mps = jump_mps;
  for (int i = 0; i < scans; ++i) drive.next();
  drive.radar(0).world_mps = 0.0;
  for (int i = 0; i < 40; ++i) {
    const Odometry odometry = drive.next();
    CAPTURE(i, to_string(odometry.status));
    CHECK((!odometry.is_usable() || twist_error(odometry, drive) < 5.0));
  }
  CHECK(drive.next().is_usable());
}

TEST_CASE("a lone radar starts once its own check knows its speed, two at once") {
  const std::vector<Pose2> alone{kFront};
  const std::vector<Pose2> two{kFront, kRearLeft};
  const auto& mounts = GENERATE_REF(alone, two);
  OdometryDrive drive(mounts, 8);
  Odometry odometry;
  for (int i = 0; i < 40; ++i) {
    for (std::size_t radar = 0; radar < mounts.size(); ++radar) {
      drive.filter().compare(radar, EgoMotion(), true, true);
    }
    odometry = drive.next();
  }
  CHECK(odometry.is_usable() == (mounts.size() > 1));
  drive.filter().compare(0, EgoMotion(), true, false);
  CHECK(drive.drive(0.6).is_usable());
}

TEST_CASE("a lone radar that suddenly shows rest is believed again when the vehicle drives") {
  OdometryDrive drive({GENERATE(kFront, kRearLeft)}, 8);
  REQUIRE(drive.drive(4.0).status == OdometryStatus::ok);
  drive.set_motion(0.0, 0.0);  // A crash, or Doppler that is stuck: it cannot be told.
  drive.drive(OdometryOptions().predicted_s);
  for (int i = 0; i < 80; ++i) {
    CHECK_FALSE(drive.next().is_usable());
  }
  for (double speed_mps = 0.0; speed_mps < 6.0; speed_mps += 0.15) {
    drive.set_motion(speed_mps, 0.0);
    drive.next();
  }
  const Odometry after = drive.drive(1.0);
  CHECK(after.is_usable());
  CHECK(twist_error(after, drive) < 5.0);
}

TEST_CASE("a step of all radars that no vehicle can make is not followed") {
  const double step_mps = GENERATE(-5.0, -4.0, -3.0, 4.0);
  CAPTURE(step_mps);
  OdometryDrive drive({kFront, kRearLeft, kRearRight}, 8);
  REQUIRE(drive.drive(2.0).status == OdometryStatus::ok);
  for (std::size_t i = 0; i < 3; ++i) {
    drive.radar(i).world_mps = step_mps;
  }
  for (int i = 0; i < 80; ++i) {
    CHECK(twist_error(drive.next(), drive) < 5.0);
  }
  CHECK_FALSE(drive.next().is_usable());
}

TEST_CASE("the velocity across is uncertain by slip times speed, also where the speed is zero") {
  OdometryDrive drive({kFront}, 9);
  drive.drive(1.0);
  drive.set_motion(0.0, 0.0);
  drive.drive(2.0);
  for (int scan = 0; scan < 20; ++scan) {
    const Odometry odometry = drive.next();
    const Eigen::Matrix3d& covariance = odometry.twist_covariance;
    const double by_slip = std::sqrt(covariance(1, 1) / covariance(0, 0));
    CHECK(by_slip == Approx(OdometryOptions().slip_std_rad).epsilon(0.5));
    CHECK(covariance.llt().info() == Eigen::Success);
  }
}

TEST_CASE("a short gap in time is bridged, a long one restarts the filter") {
  OdometryDrive drive({kFront, kRearLeft}, 9);
  drive.drive(3.0);
  drive.pass(1'500'000);
  CHECK(drive.next().status != OdometryStatus::initialising);
  CHECK(drive.drive(1.0).is_usable());
  drive.pass(5'000'000);
  const Odometry odometry = drive.next();
  CHECK(odometry.status == OdometryStatus::initialising);
  CHECK(odometry.utime_anchor_us == drive.stamp_us());
  CHECK(drive.drive(1.0).is_usable());
}

TEST_CASE("the pose since the start goes on over a gap as the vehicle did before it") {
  OdometryDrive drive({kFront}, 9);
  drive.drive(3.0);
  const double gap_s = GENERATE(1.5, 2.5, 3.5, 4.5);
  drive.pass(std::llround(1e6 * gap_s));
  drive.next();
  const Odometry after = drive.next();
  const Eigen::Vector3d error = after.odom_pose - drive.pose();
  const Eigen::Vector3d variance = after.odom_covariance.diagonal();
  CAPTURE(gap_s, error.transpose(), variance.cwiseSqrt().transpose());
  CHECK(error.cwiseAbs2().cwiseQuotient(variance).maxCoeff() < 9.0);
  CHECK(error.head<2>().norm() < 0.2 * drive.speed_mps() * gap_s);
  // 3 sigma are the way by braking with 2 m/s^2 all the time, or more.
  CHECK(std::sqrt(variance.x()) > squared(gap_s) / 3.0);
  CHECK(std::sqrt(variance.x()) < 2.0 * squared(gap_s));
}

TEST_CASE("after a silence targets are not compared with those from before it") {
  OdometryDrive drive({kFront}, 9);
  drive.drive(4.0);
  const auto compared = [&] { return drive.filter().report(0).targets.at_rest; };
  const auto before = compared();
  drive.next();
  REQUIRE(compared() > before);
  drive.pass(1'500'000);
  const auto until_silence = compared();
  drive.next();
  CHECK(compared() == until_silence);
}

TEST_CASE("the pose since the start does not span a long gap, or a clock that is set") {
  OdometryDrive drive({kFront}, 9);
  const Odometry before = drive.drive(3.0);
  const bool is_set = GENERATE(false, true);
  if (is_set) {
    drive.filter().forget();
    drive.pass(1'500'000);
  } else {
    drive.pass(60'000'000);
  }
  drive.next();
  const Odometry after = drive.next();
  const double bridged_m = is_set ? 0.0 : drive.speed_mps() * 5.0;
  CHECK((after.odom_pose - before.odom_pose).norm() == Approx(bridged_m).margin(1.5));
  const Eigen::Vector3d error = after.odom_pose - drive.pose();
  CHECK(std::abs(error.x()) > 10.0);
  CHECK(error.cwiseAbs2().cwiseQuotient(after.odom_covariance.diagonal()).maxCoeff() < 9.0);
}

TEST_CASE("distance before the first known speed is in no pose") {
  OdometryDrive drive({kFront, kRearLeft}, 12);
  Odometry blind;
  for (int i = 0; i < 3; ++i) {
    drive.pass(OdometryDrive::kPeriodUs / 2);
    blind = drive.filter().update(0, TargetSet(), drive.stamp_us());
  }
  CHECK(blind.status == OdometryStatus::initialising);
  CHECK(std::sqrt(blind.covariance(0, 0)) > 1.0);
  for (int i = 0; i < 30; ++i) {
    const std::int64_t anchor_us = blind.utime_anchor_us;
    const Odometry odometry = drive.next();
    CHECK(odometry.utime_anchor_us > anchor_us);
    if (odometry.is_new) {
      const double way_m = drive.speed_mps() * 1e-6 *
                           static_cast<double>(odometry.utime_us - odometry.utime_anchor_us);
      CHECK(std::abs(odometry.pose.x() - way_m) < 5.0 * std::sqrt(odometry.covariance(0, 0)));
      CHECK(odometry.covariance.llt().info() == Eigen::Success);
    }
  }
}

TEST_CASE("late scans are used") {
  // All scans of the rear radar arrive after front scans that were taken 50 ms later.
  OdometryOptions options;
  OdometryDrive drive({kFront}, 10, options);
  drive.set_motion(9.0, 0.3);
  OdometryFilter filter(options, {kFront, kRearLeft});
  OdometryDrive rear({kRearLeft}, 10, options);
  rear.set_motion(9.0, 0.3);
  rear.pass(OdometryDrive::kPeriodUs - 50000);
  drive.pass(OdometryDrive::kPeriodUs);
  double most = 0.0;
  for (int i = 0; i < 60; ++i) {
    const Odometry first = filter.update(0, drive.see(0), drive.stamp_us());
    const Odometry late = filter.update(1, rear.see(0), rear.stamp_us());
    CHECK((first.is_new || i == 0));
    CHECK_FALSE(late.is_new);
    CHECK(late.utime_us == first.utime_us);
    if (i > 15) {
      CHECK(late.left_out == 0U);
      CHECK(late.twist_covariance(0, 0) < first.twist_covariance(0, 0));
      most = std::max({most, twist_error(late, drive), twist_error(first, drive)});
    }
    drive.pass(OdometryDrive::kPeriodUs);
    rear.pass(OdometryDrive::kPeriodUs);
  }
  CHECK(most < 5.0);
  CHECK(filter.report(1).doppler_nis < 2.0);
  CHECK(filter.report(1).doppler_nis > 0.05);
}

TEST_CASE("targets that move are left out of the map and counted, the others are found in it") {
  OdometryDrive drive({kFront}, 13);
  std::size_t moving = 0;
  std::size_t all = 0;
  for (int i = 0; i < 60; ++i) {
    drive.pass(OdometryDrive::kPeriodUs);
    TargetSet targets;
    for (Target target : drive.see(0)) {
      if (targets.size() % 5 == 0) {
        target.doppler_mps -= 4.0;
        ++moving;
      }
      targets.add(target);
    }
    all += targets.size();
    drive.filter().update(0, targets, drive.stamp_us());
    if (i == 0) {
      // There is no map yet.
      CHECK(drive.filter().report(0).targets.at_rest == 0);
      all = drive.filter().report(0).targets.moving;
    }
  }
  const MapCounters counters = drive.filter().report(0).targets;
  CHECK(counters.at_rest + counters.moving == all);
  CHECK(static_cast<double>(counters.moving) == Approx(static_cast<double>(moving)).epsilon(0.05));
  CHECK(counters.found > counters.at_rest / 2);
  CHECK(counters.found < counters.at_rest);
}

TEST_CASE(
    "two radars with scales of Doppler 2 % apart go on, less sure of the way until it is learned") {
  const auto guilty = GENERATE(std::size_t{0}, std::size_t{1});
  const double scale = GENERATE(0.98, 1.02);
  const double wrong_from_s = GENERATE(0.0, 3.0);
  CAPTURE(guilty, scale, wrong_from_s);
  OdometryDrive drive({kFront, kRearLeft}, 12);
  drive.set_motion(20.0, 0.05);
  drive.drive(wrong_from_s);
  drive.radar(guilty).doppler_scale = scale;
  int scans_of_start = 0;
  int scans = 0;
  int usable = 0;
  while (scans < 200) {
    const Odometry odometry = drive.next();
    scans_of_start += usable == 0 ? 1 : 0;
    scans += usable > 0 ? 1 : 0;
    usable += odometry.status == OdometryStatus::ok ? 1 : 0;
    if (odometry.status == OdometryStatus::ok) {
      const double error_mps = odometry.twist.x() - drive.speed_mps();
      CHECK(std::abs(error_mps) <= 5.0 * std::sqrt(odometry.twist_covariance(0, 0)));
    }
  }
  CHECK(scans_of_start <= 18);  // 0.7 s
  CHECK(usable >= 0.95 * scans);
  // The other radar's error is the difference of both: which of them is wrong, positions tell.
  const RadarReport report = drive.filter().report(guilty);
  const RadarReport other = drive.filter().report(1 - guilty);
  CHECK(report.doppler_scale - other.doppler_scale == Approx(scale - 1.0).margin(0.008));
  CHECK(std::abs(drive.filter().state().mean(state_layout::kSpeed) - 20.0) < 0.2);
}

TEST_CASE("the yaw error of a mount is learned, also from 5 to 15 targets a scan") {
  const double density = GENERATE(1.0, 0.1);
  OdometryDrive drive({kFront, kRearLeft, kRearRight}, 11);
  drive.thin_out(density);
  drive.radar(0).mount.yaw_rad += 0.015;
  for (int i = 0; i < 12; ++i) {
    drive.set_motion(9.0, i % 2 == 0 ? 0.2 : -0.2);
    CHECK(drive.drive(1.0).left_out == 0U);
  }
  const RadarReport front = drive.filter().report(0);
  const RadarReport rear = drive.filter().report(1);
  // Slip explains a part of the common error.
  CHECK(front.mount_yaw_rad - rear.mount_yaw_rad == Approx(0.015).margin(0.004));
  CHECK(front.mount_yaw_std_rad < 0.9 * OdometryOptions().mount_yaw_std_rad);
}

}  // namespace
}  // namespace cremed
