// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/motion/ego_motion_estimator.hpp"
#include "test/estimator/drive.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using simulation::Drive;
using simulation::kFront;

std::unique_ptr<EgoMotionEstimator> make_estimator(const Pose2& mount,
                                                   void (*change)(EgoMotionOptions&) = nullptr) {
  EgoMotionOptions options;
  options.vehicle_from_radar = mount;
  if (change != nullptr) {
    change(options);
  }
  return std::make_unique<EgoMotionEstimator>(options);
}

/// Invariants of every motion: numbers if and only if there is an estimate.
void check_consistent(const EgoMotion& motion) {
  const bool has_estimate =
      motion.status == MotionStatus::ok || motion.status == MotionStatus::standing_still;
  CHECK(motion.has_estimate() == has_estimate);
  if (has_estimate) {
    CHECK(motion.motion.allFinite());
    CHECK(motion.covariance.allFinite());
    CHECK(motion.utime_us > motion.utime_start_us);
  } else {
    CHECK(motion.motion.array().isNaN().all());
    CHECK(motion.covariance.array().isNaN().all());
  }
}

/// Is the motion that of `periods` periods of the drive, within five standard deviations?
void check_motion(const EgoMotion& motion, const Drive& drive, double periods) {
  REQUIRE(motion.has_estimate());
  CHECK(motion.utime_us - motion.utime_start_us ==
        static_cast<std::int64_t>(std::lround(periods * static_cast<double>(Drive::kPeriodUs))));
  const Eigen::Vector3d error = motion.motion - drive.motion_per_period() * periods;
  CAPTURE(motion.motion.transpose(), error.transpose());
  CHECK(numeric::normalised_error(error, motion.covariance, 2) < 25.0);
}

TEST_CASE("a status has the name of the CSV and the number of the message") {
  const std::array<std::string, kMotionStatusCount> names = {
      "ok",           "standing_still",  "no_reference", "incomplete_scan",
      "gap_too_long", "too_few_targets", "degenerate",   "no_convergence",
      "non_finite",   "implausible",     "ambiguous"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    CHECK(to_string(static_cast<MotionStatus>(i)) == names[i]);
  }
  CHECK(static_cast<std::size_t>(MotionStatus::ambiguous) + 1 == kMotionStatusCount);
  check_consistent(EgoMotion());
}

TEST_CASE("each scan after the first gives the motion since the previous one") {
  Drive drive({8.0, 0.0, 0.1}, kFront);
  const auto estimator = make_estimator(kFront);
  const RadarScan first = drive.next();
  const EgoMotion none = estimator->update(first);
  check_consistent(none);
  CHECK(none.status == MotionStatus::no_reference);
  CHECK(none.utime_us == first.stamp_us);
  CHECK(none.utime_start_us == first.stamp_us);
  CHECK(none.targets == first.count);
  CHECK(none.iterations == 0);
  for (int i = 0; i < 20; ++i) {
    const RadarScan scan = drive.next();
    const EgoMotion motion = estimator->update(scan);
    check_consistent(motion);
    CHECK(motion.status == MotionStatus::ok);
    CHECK(motion.utime_us == scan.stamp_us);
    CHECK(motion.targets == scan.count);
    CHECK(motion.iterations > 0);
    check_motion(motion, drive, 1.0);
  }
}

TEST_CASE("an unusable scan is skipped, and the next motion starts at the last usable one") {
  struct Row {
    std::string what;
    void (*spoil)(RadarScan&);
    MotionStatus status;
  };
  const std::vector<Row> rows = {
      {"conflict", [](RadarScan& s) { s.status = ScanStatus::conflicting_parts; },
       MotionStatus::incomplete_scan},
      {"capacity", [](RadarScan& s) { s.status = ScanStatus::over_capacity; },
       MotionStatus::incomplete_scan},
      {"four", [](RadarScan& s) { s.count = 4; }, MotionStatus::too_few_targets},
      {"none", [](RadarScan& s) { s.count = 0; }, MotionStatus::too_few_targets},
      {"NaN range", [](RadarScan& s) { s.detections[2].range_m = numeric::kNan; },
       MotionStatus::non_finite},
      {"NaN azimuth", [](RadarScan& s) { s.detections[0].azimuth_rad = numeric::kNan; },
       MotionStatus::non_finite},
      {"infinite Doppler", [](RadarScan& s) { s.detections[1].doppler_mps = numeric::kInfinity; },
       MotionStatus::non_finite},
      {"no deviation", [](RadarScan& s) { s.detections[1].doppler_std_mps = 0.0; },
       MotionStatus::non_finite},
  };
  for (const Row& row : rows) {
    CAPTURE(row.what);
    Drive drive({8.0, 0.0, 0.1}, kFront);
    const auto estimator = make_estimator(kFront);
    const RadarScan first = drive.next();
    estimator->update(first);
    RadarScan spoilt = drive.next();
    row.spoil(spoilt);
    const EgoMotion nothing = estimator->update(spoilt);
    check_consistent(nothing);
    CHECK(nothing.status == row.status);
    CHECK(nothing.targets == (row.status == MotionStatus::incomplete_scan ? 0 : spoilt.count));
    CHECK(nothing.utime_start_us == first.stamp_us);
    CHECK(nothing.utime_us == spoilt.stamp_us);
    check_motion(estimator->update(drive.next()), drive, 2.0);
    check_motion(estimator->update(drive.next()), drive, 1.0);
  }
}

TEST_CASE("Doppler at the end of an acceleration is not taken for the mean speed") {
  const Pose2 rear{-0.9, 0.3, std::numbers::pi};
  for (const double acceleration_mps2 : {-3.0, 3.0}) {
    for (const Pose2& mount : {kFront, rear}) {
      for (const int periods : {1, 3}) {
        CAPTURE(acceleration_mps2, mount.x_m, periods);
        Drive drive({14.0, 0.0, 0.2}, mount, 3, 120);
        const auto estimator = make_estimator(mount);
        // The yaw rate is known once there is an estimate.
        estimator->update(drive.next());
        estimator->update(drive.next());
        drive.set_acceleration(acceleration_mps2);
        estimator->update(drive.next());
        drive.pass((periods - 1) * Drive::kPeriodUs);
        const EgoMotion motion = estimator->update(drive.next());
        REQUIRE(motion.has_estimate());
        const double span_s = 0.1 * periods;
        const Eigen::Vector3d truth(14.0 * span_s + 0.5 * acceleration_mps2 * span_s * span_s, 0.0,
                                    0.2 * span_s);
        // If taken for the mean, Doppler would err by 15 or 135 mm.
        CHECK(std::abs(motion.motion.x() - truth.x()) < 0.005 * periods);
        CHECK(numeric::normalised_error(motion.motion - truth, motion.covariance, 2) < 25.0);
      }
    }
  }
}

TEST_CASE("a learned factor corrects Doppler, that of the last scan too, and no motion spans it") {
  constexpr double kScale = 0.9;
  constexpr double kOffsetMps = 0.05;
  Drive drive({8.0, 0.0, 0.1}, kFront);
  const auto estimator = make_estimator(kFront, [](EgoMotionOptions& options) {
    options.correction.doppler_offset_mps = kOffsetMps;
  });
  const auto next = [&] {
    RadarScan scan = drive.next();
    for (std::size_t i = 0; i < static_cast<std::size_t>(scan.count); ++i) {
      double& doppler_mps = scan.detections[i].doppler_mps;
      doppler_mps = kScale * doppler_mps + kOffsetMps;
    }
    return scan;
  };
  estimator->update(next());
  estimator->update(next());
  const TargetSet before = estimator->targets();
  estimator->correct_doppler(1.0 / kScale);
  REQUIRE(estimator->targets().size() == before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    CHECK(estimator->targets()[i].doppler_mps == Approx(before[i].doppler_mps / kScale));
  }
  CHECK(estimator->update(next()).status == MotionStatus::no_reference);
  for (int i = 0; i < 10; ++i) {
    check_motion(estimator->update(next()), drive, 1.0);
  }
}

TEST_CASE("an incomplete scan is used with the targets it has, and flagged") {
  const ScanStatus why = GENERATE(ScanStatus::missing_parts, ScanStatus::dropped_frames);
  Drive drive({8.0, 0.0, 0.1}, kFront);
  const auto estimator = make_estimator(kFront);
  estimator->update(drive.next());
  RadarScan holed = drive.next();
  holed.status = why;
  const std::uint16_t whole = holed.count;
  holed.count = static_cast<std::uint16_t>(whole * 3 / 4);  // The far quarter is missing.
  const EgoMotion motion = estimator->update(holed);
  check_motion(motion, drive, 1.0);
  CHECK(motion.incomplete);
  CHECK(motion.targets == holed.count);
  const EgoMotion next = estimator->update(drive.next());
  check_motion(next, drive, 1.0);
  CHECK_FALSE(next.incomplete);
}

TEST_CASE("an unusable scan is no reference") {
  Drive drive({8.0, 0.0, 0.0}, kFront);
  const auto estimator = make_estimator(kFront);
  RadarScan incomplete = drive.next();
  incomplete.status = ScanStatus::conflicting_parts;
  CHECK(estimator->update(incomplete).status == MotionStatus::incomplete_scan);
  CHECK(estimator->update(drive.next()).status == MotionStatus::no_reference);
  CHECK(estimator->update(drive.next()).status == MotionStatus::ok);
}

TEST_CASE("after a gap or a step back in time the motion restarts") {
  struct Row {
    std::int64_t step_us;
    MotionStatus status;
  };
  const std::vector<Row> rows = {{500000, MotionStatus::ok},
                                 {500001, MotionStatus::gap_too_long},
                                 {3600000000, MotionStatus::gap_too_long},
                                 {1, MotionStatus::ok},
                                 {0, MotionStatus::gap_too_long},
                                 {-1, MotionStatus::gap_too_long},
                                 {-100000, MotionStatus::gap_too_long},
                                 {-3600000000, MotionStatus::gap_too_long}};
  for (const Row& row : rows) {
    CAPTURE(row.step_us);
    Drive drive(Eigen::Vector3d::Zero(), kFront);
    const auto estimator = make_estimator(kFront, [](EgoMotionOptions& options) {
      options.standstill_mps = 0.0;
      options.max_speed_mps = 1e9;
      options.max_yaw_rate_radps = 1e9;
    });
    RadarScan scan = drive.next();
    const std::int64_t start_us = scan.stamp_us;
    estimator->update(scan);
    scan = drive.next();
    scan.stamp_us = start_us + row.step_us;
    const EgoMotion motion = estimator->update(scan);
    check_consistent(motion);
    CHECK(motion.status == row.status);
    CHECK(motion.utime_start_us == start_us);
    scan = drive.next();
    scan.stamp_us = start_us + row.step_us + Drive::kPeriodUs;
    check_motion(estimator->update(scan), drive, 1.0);
  }
}

TEST_CASE("extreme stamps are gaps, not motions") {
  constexpr std::int64_t kEnd = std::numeric_limits<std::int64_t>::max();
  constexpr std::int64_t kBegin = std::numeric_limits<std::int64_t>::min();
  const std::vector<std::array<std::int64_t, 2>> rows = {
      {kEnd, kBegin + Drive::kPeriodUs - 1}, {kEnd, -2}, {kBegin, kEnd}, {kBegin, kBegin}};
  for (const auto& [from_us, to_us] : rows) {
    CAPTURE(from_us, to_us);
    Drive drive({8.0, 0.0, 0.0}, kFront);
    const auto estimator = make_estimator(kFront);
    RadarScan scan = drive.next();
    scan.stamp_us = from_us;
    estimator->update(scan);
    scan = drive.next();
    scan.stamp_us = to_us;
    CHECK(estimator->update(scan).status == MotionStatus::gap_too_long);
  }
}

TEST_CASE("selection counts the detections of usable scans") {
  Drive drive({8.0, 0.0, 0.0}, kFront);
  const auto estimator = make_estimator(kFront);
  RadarScan scan = drive.next();
  const std::uint64_t count = scan.count;
  estimator->update(scan);
  CHECK(estimator->selection().used == count);
  scan.status = ScanStatus::conflicting_parts;
  estimator->update(scan);
  CHECK(estimator->selection().used == count);
  scan.status = GENERATE(ScanStatus::complete, ScanStatus::missing_parts);
  scan.detections[0].validity = Validity::moving;
  scan.detections[1].validity = Validity::no_noise;
  scan.detections[2].range_m = 400.0;
  const EgoMotion motion = estimator->update(scan);
  CHECK(motion.targets == static_cast<int>(count) - 3);
  CHECK(estimator->selection().used == 2 * count - 3);
  CHECK(estimator->selection().moving == 1);
  CHECK(estimator->selection().no_noise == 1);
  CHECK(estimator->selection().outside_limits == 1);
}

}  // namespace
}  // namespace cremed
