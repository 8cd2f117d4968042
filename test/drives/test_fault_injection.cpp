// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The instruments of the fault matrix: what is injected, and what the judge says of it.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "test/faults/fault_verdict.hpp"
#include "test/faults/systematic_faults.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

/// Two ARS408 in front and at the rear, one on each side.
FaultDrive drive_of_ars408(double duration_s) {
  return simulated_fault_drive("bends", duration_s,
                               {radar("front", "can0", {3.4, 0.0, 0.0}, Ars408Options{}),
                                radar("rear", "can1", {-0.5, 0.0, 3.1}, Ars408Options{}),
                                radar("left", "can2", {2.4, 0.8, 1.56}, Ars408Options{}),
                                radar("right", "can3", {2.4, -0.8, -1.56}, Ars408Options{})});
}

FaultTime seconds(const FaultDrive& drive, double from_s, double until_s) {
  return {drive.start_us() + std::llround(from_s * 1e6),
          drive.start_us() + std::llround(until_s * 1e6)};
}

FaultCase changed(FaultTime time, PutIn put_in) { return {"changed", "", time, std::move(put_in)}; }

}  // namespace

TEST_CASE("A truck ahead leaves every scan complete, at rest relative to the radar") {
  const FaultDrive drive = drive_of_ars408(3.0);
  const FaultTime time = seconds(drive, 1.0, 2.0);
  const FaultRecord result = record(drive, changed(time, [](const FaultDrive& d, FaultTime t) {
                                      return TruckAhead(t, 0, 40).in(d.frames);
                                    }));
  std::size_t with_truck = 0;
  for (const RadarScan& scan : result.sink.scans[0]) {
    CHECK(scan.status == ScanStatus::complete);
    const auto on_truck =
        std::count_if(scan.detections.begin(), scan.detections.begin() + scan.count,
                      [](const Detection& detection) {
                        return detection.doppler_mps == 0.0 && detection.range_m < 21.0;
                      });
    const bool is_in_time = scan.stamp_us >= time.from_us && scan.stamp_us < time.until_us;
    CHECK((on_truck >= 40) == is_in_time);
    with_truck += is_in_time ? 1 : 0;
  }
  CHECK(with_truck > 10);
}

TEST_CASE("Radars that hang repeat one scan with a counter that runs on") {
  const FaultDrive drive = drive_of_ars408(3.0);
  const FaultTime time = seconds(drive, 1.0, 2.0);
  const FaultRecord result = record(drive, changed(time, put(with_repeated_scan)));
  std::size_t repeated = 0;
  for (const auto& scans : result.sink.scans) {
    for (std::size_t i = 1; i < scans.size(); ++i) {
      CHECK(scans[i].status == ScanStatus::complete);
      CHECK(scans[i].counter == static_cast<std::uint16_t>(scans[i - 1].counter + 2));
      const bool is_same = scans[i].count == scans[i - 1].count &&
                           scans[i].detections[0].range_m == scans[i - 1].detections[0].range_m &&
                           scans[i].detections[1].range_m == scans[i - 1].detections[1].range_m;
      const bool is_in_time =
          scans[i].stamp_us >= time.from_us && scans[i].stamp_us < time.until_us;
      CHECK(is_same == is_in_time);
      repeated += is_same ? 1 : 0;
    }
  }
  CHECK(repeated > 40);
}

TEST_CASE("Late stamps are those of arrival, in order") {
  const FaultDrive drive = drive_of_ars408(1.0);
  const Frames late = with_late_stamps(drive.frames, seconds(drive, 0.0, 1.0), 1, 300'000);
  REQUIRE(late.size() == drive.frames.size());
  CHECK(std::is_sorted(late.begin(), late.end(), [](const CanFrame& a, const CanFrame& b) {
    return a.stamp_us < b.stamp_us;
  }));
  const auto first = std::find_if(late.begin(), late.end(),
                                  [](const CanFrame& frame) { return frame.interface == 1; });
  CHECK(first->stamp_us >= drive.start_us() + 300'000);
}

TEST_CASE("The judge: a healthy drive is right, one with another truth is not") {
  FaultDrive drive = drive_of_ars408(14.0);
  const FaultCase none{"none", "", {drive.start_us(), kNever}};
  const FaultRecord healthy = record(drive, none);
  const DriveFigures right = DriveJudge(drive, none, healthy).figures();
  CHECK(right.usable > 500);
  CHECK(right.beyond == 0);
  CHECK(right.windows > 0);
  CHECK(right.window_m < 3.0);
  CHECK(std::accumulate(right.status.begin(), right.status.end(), 0.0) == Approx(1.0).margin(0.01));
  CHECK(verdict_of(none, right).failures().empty());

  std::vector<Pose2> poses = drive.truth.poses();
  for (Pose2& pose : poses) {
    pose.x_m *= 1.3;
    pose.y_m *= 1.3;
  }
  drive.truth = TrueTrajectory(drive.truth.utime_us(), poses);
  const DriveFigures wrong = DriveJudge(drive, none, healthy).figures();
  CHECK(wrong.usable == right.usable);
  CHECK(wrong.beyond_share() > 0.9);
  CHECK(wrong.window_m > 20.0);
  CHECK(verdict_of(none, wrong).failures() == "BO");
}

TEST_CASE("The judge follows a clock that is set") {
  const FaultDrive drive = drive_of_ars408(14.0);
  const FaultRecord healthy = record(drive, {"none", "", {drive.start_us(), kNever}});
  constexpr std::int64_t kHeldUs = 75'000;  // Scans from before the step come so much after it.
  for (const std::int64_t step_us : {1'000'000, -100'000, -1'000'000}) {
    FaultCase fault{"set", "", seconds(drive, 5.0, 100.0)};
    fault.clock_step_us = step_us;
    FaultRecord stepped = healthy;
    for (std::size_t i = 0; i < stepped.given.size(); ++i) {
      Odometry& row = stepped.sink.odometries[i];
      const bool is_after = row.utime_us >= fault.time.from_us;
      row.utime_us += is_after ? step_us : 0;
      row.utime_anchor_us += row.utime_anchor_us >= fault.time.from_us ? step_us : 0;
      const bool is_given_after =
          healthy.sink.odometries[i].utime_us + kHeldUs >= fault.time.from_us;
      stepped.given[i] = {
          is_given_after ? step_us : 0,
          healthy.sink.odometries[i].utime_us + kHeldUs + (is_given_after ? step_us : 0)};
    }
    const DriveFigures figures = DriveJudge(drive, fault, stepped).figures();
    CHECK(figures.beyond == 0);
    CHECK(figures.odom_sigmas < 5.0);
    stepped.given.assign(stepped.given.size(), {});
    const DriveFigures of_frames = DriveJudge(drive, fault, stepped).figures();
    CHECK(of_frames.worst_sigmas > 5.0);
    CHECK((of_frames.beyond_share() > 0.3 || step_us == -100'000));
  }
}

TEST_CASE("The judge: who is named, when, and how long") {
  const FaultDrive drive = drive_of_ars408(4.0);
  FaultCase fault{"named", "front", seconds(drive, 1.0, 3.0)};
  fault.guilty = 1U;
  FaultRecord result{RecordingSink(drive.radars.size()), {}};
  const FaultTime named = seconds(drive, 2.0, 3.0);
  for (std::int64_t us = drive.start_us(); us < drive.frames.back().stamp_us; us += 20'000) {
    Odometry row;
    row.utime_us = row.utime_anchor_us = us;
    row.odom_covariance = 1e6 * Eigen::Matrix3d::Identity();  // The poses are not judged here.
    row.status = us < fault.time.until_us ? OdometryStatus::lost : OdometryStatus::ok;
    row.left_out = us >= named.from_us && us < named.until_us ? 1U : 0U;
    result.sink.odometries.push_back(row);
    result.given.emplace_back();
  }
  RadarStatus status;
  status.utime_us = drive.start_us() + 3'500'000;
  status.belief.doubts = 1;
  result.sink.statuses[2] = {status};

  const DriveFigures figures = DriveJudge(drive, fault, result).figures();
  CHECK(figures.status_share(OdometryStatus::lost) == Approx(2.0 / 3.0).margin(0.01));
  CHECK(figures.radars[0].named_after_s == Approx(1.0).margin(0.03));
  CHECK(figures.radars[0].left_out == Approx(1.0 / 3.0).margin(0.01));
  CHECK_FALSE(figures.radars[1].named_after_s);
  CHECK(figures.radars[2].doubted == Approx(0.5 / 3.0).margin(0.01));
  CHECK(figures.radars[2].named_after_s == Approx(2.5));
  CHECK(figures.recovery_s == Approx(0.0).margin(0.03));
  const FaultVerdict verdict = verdict_of(fault, figures);
  CHECK(verdict.failures() == "I");
}
