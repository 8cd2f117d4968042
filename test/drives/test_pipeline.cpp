// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "test/tools/pipeline_bench.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

SimulationOptions options(std::uint64_t seed, double duration_s) {
  SimulationOptions result;
  result.seed = seed;
  result.duration_s = duration_s;
  return result;
}

/// Requirements on every drive.
void check_invariants(const RecordingSink& sink) {
  for (std::size_t radar = 0; radar < sink.motions.size(); ++radar) {
    REQUIRE(sink.motions[radar].size() == sink.scans[radar].size());
    for (std::size_t i = 0; i < sink.motions[radar].size(); ++i) {
      const EgoMotion& motion = sink.motions[radar][i];
      CHECK(motion.utime_us == sink.scans[radar][i].stamp_us);
      CHECK(motion.has_estimate() == motion.motion.allFinite());
      CHECK(motion.has_estimate() == motion.covariance.allFinite());
      const ScanStatus scan = sink.scans[radar][i].status;
      CHECK(motion.incomplete == (scan != ScanStatus::complete));
      CHECK((motion.status == MotionStatus::incomplete_scan) ==
            (scan == ScanStatus::conflicting_parts || scan == ScanStatus::over_capacity));
      if (motion.has_estimate()) {
        CHECK(motion.utime_start_us < motion.utime_us);
        CHECK(motion.utime_us - motion.utime_start_us <= 500'000);
        CHECK(motion.covariance(0, 0) > 0.0);
        CHECK(motion.covariance(2, 2) > 0.0);
      }
    }
  }
}

}  // namespace

TEST_CASE("Drives of every kind: the front radar is accurate, and knows how accurate") {
  // Bounds hold for any seed: ANEES of n = 300 estimates lies within 1 +- 0.12 if all errors are
  // Gaussian; the rest is margin for unmodelled effects (acceleration within a cycle).
  struct Row {
    const char* scenario;
    double max_rmse_m;
    double max_rmse_deg;
  };
  const auto row =
      GENERATE(Row{"straight", 0.01, 0.35}, Row{"bends", 0.02, 0.35}, Row{"stop-and-go", 0.01, 0.3},
               Row{"standing", 0.006, 0.25}, Row{"city", 0.012, 0.35});
  CAPTURE(row.scenario);
  const Drive simulated = drive(scenario(row.scenario), default_radars(), options(8, 25.0));
  const RecordingSink sink = run_pipeline(simulated.radars, simulated.frames);
  check_invariants(sink);

  const Credibility front = credibility_of(sink.motions[0], truth_of(simulated));
  CHECK(front.count() >= 300);
  CHECK(front.rmse_m() < row.max_rmse_m);
  CHECK(front.rmse_deg() < row.max_rmse_deg);
  CHECK(front.anees() > 0.5);
  CHECK(front.anees() < 1.7);
  const Credibility rear = credibility_of(sink.motions[1], truth_of(simulated));
  CHECK(rear.count() >= 230);
  CHECK(rear.rmse_m() < 0.03);
  CHECK(rear.anees() < 1.7);
  CHECK(rear.rmse_deg() < 0.5);
}

TEST_CASE("A standing vehicle is told from a driving one") {
  const Drive standing = drive(scenario("standing"), default_radars(), options(3, 10.0));
  const auto standing_motions = run_pipeline(standing.radars, standing.frames).motions;
  for (const auto& motions : standing_motions) {
    for (const EgoMotion& motion : motions) {
      if (motion.has_estimate()) {
        CHECK(std::abs(motion.motion.x()) < 0.03);
        CHECK(std::abs(motion.motion.z()) < 0.02);
      }
    }
  }
  for (const auto& motions : standing_motions) {
    CHECK(2 * count_status(motions, MotionStatus::standing_still) > motions.size());
  }

  const Drive driving = drive(scenario("straight"), default_radars(), options(3, 10.0));
  for (const auto& motions : run_pipeline(driving.radars, driving.frames).motions) {
    CHECK(count_status(motions, MotionStatus::standing_still) == 0);
  }
}

/// Also for NaN, which equals nothing.
template <typename Matrix>
bool has_same_bits(const Matrix& a, const Matrix& b) {
  return std::memcmp(a.data(), b.data(), sizeof(Matrix)) == 0;
}

TEST_CASE("The same frames give the same bits") {
  const Drive simulated = drive(scenario("bends"), default_radars(), options(11, 5.0));
  const RecordingSink a = run_pipeline(simulated.radars, simulated.frames);
  const RecordingSink b = run_pipeline(simulated.radars, simulated.frames);
  REQUIRE(a.motions[0].size() == b.motions[0].size());
  for (std::size_t i = 0; i < a.motions[0].size(); ++i) {
    CHECK(has_same_bits(a.motions[0][i].motion, b.motions[0][i].motion));
    CHECK(has_same_bits(a.motions[0][i].covariance, b.motions[0][i].covariance));
  }
  REQUIRE(a.odometries.size() == b.odometries.size());
  for (std::size_t i = 0; i < a.odometries.size(); ++i) {
    CHECK(has_same_bits(a.odometries[i].odom_pose, b.odometries[i].odom_pose));
    CHECK(has_same_bits(a.odometries[i].covariance, b.odometries[i].covariance));
  }
}

TEST_CASE("Each radar's result does not depend on the other radars of the vehicle") {
  const Drive simulated = drive(scenario("bends"), default_radars(), options(11, 5.0));
  const RecordingSink both = run_pipeline(simulated.radars, simulated.frames);
  std::vector<CanFrame> rear_frames;
  for (CanFrame frame : simulated.frames) {
    if (frame.interface == 1) {
      frame.interface = 0;
      rear_frames.push_back(frame);
    }
  }
  const RecordingSink alone = run_pipeline({simulated.radars[1]}, rear_frames);
  REQUIRE(alone.motions[0].size() == both.motions[1].size());
  REQUIRE(alone.motions[0].size() > 40);
  for (std::size_t i = 1; i < alone.motions[0].size(); ++i) {
    CHECK(has_same_bits(alone.motions[0][i].motion, both.motions[1][i].motion));
  }
}

/// Frames of the drive without those of an interface between two times since its start.
std::vector<CanFrame> without(const Drive& simulated, std::uint8_t interface, double from_s,
                              double to_s) {
  const auto at_us = [&](double s) {
    return simulated.frames.front().stamp_us + static_cast<std::int64_t>(s * 1e6);
  };
  std::vector<CanFrame> frames;
  std::copy_if(simulated.frames.begin(), simulated.frames.end(), std::back_inserter(frames),
               [&](const CanFrame& frame) {
                 return frame.interface != interface || frame.stamp_us < at_us(from_s) ||
                        frame.stamp_us >= at_us(to_s);
               });
  return frames;
}

/// Whether the pose in the frame of the anchor is within five sigma of truth.
bool is_credible(const Odometry& odometry, const TrueTrajectory& truth) {
  const auto true_pose = truth.motion(odometry.utime_anchor_us, odometry.utime_us);
  const Eigen::Vector3d sigma = odometry.covariance.diagonal().cwiseSqrt();
  return !true_pose ||
         ((odometry.pose - *true_pose).array().abs() <= 5.0 * sigma.array() + 1e-6).all();
}

TEST_CASE("Odometry: outputs follow each other, and the fused motions are those between them") {
  const Drive simulated = drive(scenario("bends"), default_radars(), options(6, 20.0));
  const RecordingSink sink = run_pipeline(simulated.radars, simulated.frames);
  const TrueTrajectory truth = truth_of(simulated);
  REQUIRE(sink.odometries.size() > 400);
  REQUIRE(sink.fused.size() == sink.odometries.size());
  for (std::size_t i = 0; i < sink.fused.size(); ++i) {
    const Odometry& odometry = sink.odometries[i];
    const EgoMotion& fused = sink.fused[i];
    CHECK((i == 0 || odometry.utime_before_us == sink.odometries[i - 1].utime_us));
    CHECK(fused.utime_start_us == odometry.utime_before_us);
    CHECK(fused.utime_us == odometry.utime_us);
    CHECK(fused.targets > 0);
    const bool is_good = odometry.status == OdometryStatus::ok;
    CHECK(fused.has_estimate() == is_good);
    if (is_good) {
      CHECK(has_same_bits(fused.motion, odometry.motion));
      CHECK(has_same_bits(fused.covariance, odometry.motion_covariance));
      CHECK(is_credible(odometry, truth));
    }
  }
  const auto true_motion =
      truth.motion(sink.odometries.front().utime_before_us, sink.odometries.back().utime_us);
  REQUIRE(true_motion);
  const Eigen::Vector3d error = sink.odometries.back().odom_pose - *true_motion;
  CHECK(error.head<2>().norm() < 0.02 * 20.0 * 8.0);  // 2 % of the way.
  for (std::size_t radar = 0; radar < 2; ++radar) {
    CHECK(sink.statuses[radar].back().scans_in_odometry > 150);
  }
}

/// Stamps of all radars' scans in the order of completion.
class CompletionSink final : public OdometrySink {
 public:
  void on_scan(std::size_t, const RadarScan&) override {}
  void on_motion(std::size_t, const EgoMotion& motion, std::int32_t) override {
    whole_us.push_back(motion.utime_us);
  }
  void on_odometry(const Odometry& odometry) override { used_us.push_back(odometry.utime_us); }
  void on_fused(const EgoMotion&, std::int32_t) override {}
  void on_status(std::size_t, const RadarStatus&) override {}
  [[nodiscard]] std::uint64_t failures() const override { return 0; }

  std::vector<std::int64_t> whole_us;
  std::vector<std::int64_t> used_us;
};

TEST_CASE("Odometry takes scans in the order of their stamps, whichever is whole first") {
  const Drive simulated = drive(scenario("bends"), default_radars(), options(7, 5.0));
  CompletionSink sink;
  Pipeline pipeline(configuration_of(simulated.radars), kNoSource, {&sink}, {});
  play(simulated.frames, pipeline);
  CHECK_FALSE(std::is_sorted(sink.whole_us.begin(), sink.whole_us.end()));
  std::sort(sink.whole_us.begin(), sink.whole_us.end());
  // The odometry starts at the first scan.
  CHECK(std::vector(sink.whole_us.begin() + 1, sink.whole_us.end()) == sink.used_us);
}

TEST_CASE("Odometry of one radar: a state, and no fused motion") {
  const Drive simulated = drive(scenario("bends"), default_radars(), options(6, 20.0));
  const RecordingSink sink = run_pipeline({simulated.radars[0]}, without(simulated, 1, 0.0, 100.0));
  const TrueTrajectory truth = truth_of(simulated);
  CHECK(sink.fused.empty());
  REQUIRE(sink.odometries.size() > 200);
  CHECK(sink.odometries.back().status == OdometryStatus::ok);
  for (const Odometry& odometry : sink.odometries) {
    CHECK((odometry.status != OdometryStatus::ok || is_credible(odometry, truth)));
  }
}

TEST_CASE("Odometry that is switched off is neither there nor fused") {
  const Drive simulated = drive(scenario("bends"), default_radars(), options(6, 2.0));
  Configuration configuration = configuration_of(simulated.radars);
  configuration.odometry.enabled = false;
  RecordingSink sink(2);
  Pipeline pipeline(configuration, kNoSource, {&sink}, {});
  play(simulated.frames, pipeline);
  CHECK(sink.motions[0].size() > 20);
  CHECK(sink.odometries.empty());
  CHECK(sink.fused.empty());
  CHECK_FALSE(pipeline.odometry());
}

TEST_CASE("Odometry goes on while a radar is silent, and takes it back within a second") {
  const std::uint8_t silent = GENERATE(std::uint8_t{0}, std::uint8_t{1});
  CAPTURE(int{silent});
  const Drive simulated = drive(scenario("bends"), default_radars(), options(7, 20.0));
  const RecordingSink sink = run_pipeline(simulated.radars, without(simulated, silent, 6.0, 12.0));
  const TrueTrajectory truth = truth_of(simulated);
  const std::int64_t begin_us = simulated.frames.front().stamp_us;
  bool is_back = false;
  for (const Odometry& odometry : sink.odometries) {
    const double time_s = static_cast<double>(odometry.utime_us - begin_us) * 1e-6;
    CAPTURE(time_s);
    const bool takes_part = ((odometry.radars >> silent) & 1U) != 0;
    if (time_s > 2.0) {
      CHECK(odometry.status == OdometryStatus::ok);
      CHECK(is_credible(odometry, truth));
    }
    CHECK_FALSE((takes_part && time_s > 6.2 && time_s < 11.8));
    is_back = is_back || (takes_part && time_s > 12.0 && time_s < 13.0);
  }
  CHECK(is_back);
}

TEST_CASE("No odometry spans a step of the clock") {
  const Drive simulated = drive(scenario("bends"), default_radars(), options(8, 8.0));
  RecordingSink sink(2);
  Pipeline pipeline(configuration_of(simulated.radars), kNoSource, {&sink}, {});
  const std::size_t middle = simulated.frames.size() / 2;
  for (std::size_t i = 0; i < simulated.frames.size(); ++i) {
    if (i == middle) {
      pipeline.on_clock_step();
    }
    pipeline.on_frame(simulated.frames[i]);
  }
  pipeline.finish();
  const std::int64_t step_us = simulated.frames[middle].stamp_us;
  for (const Odometry& odometry : sink.odometries) {
    CHECK((odometry.utime_us < step_us) == (odometry.utime_before_us < step_us));
    CHECK((odometry.utime_us < step_us) == (odometry.utime_anchor_us < step_us));
  }
  CHECK(sink.odometries.back().status == OdometryStatus::ok);
}

TEST_CASE("Lost frames cost their targets and nothing else") {
  const Drive simulated = drive(scenario("lossy"), default_radars(), options(5, 30.0));
  const RecordingSink sink = run_pipeline(simulated.radars, simulated.frames);
  check_invariants(sink);
  for (const auto& motions : sink.motions) {
    const auto holed = std::count_if(motions.begin(), motions.end(), [](const EgoMotion& motion) {
      return motion.incomplete && motion.has_estimate();
    });
    CHECK(holed > 5);
    const auto estimates = std::count_if(motions.begin(), motions.end(),
                                         [](const EgoMotion& m) { return m.has_estimate(); });
    CHECK(static_cast<double>(estimates) > 0.97 * static_cast<double>(motions.size()));
  }
  // The estimate after a lost scan starts at the last complete one: the motions have no gap.
  const auto& motions = sink.motions[0];
  std::int64_t reached_us = 0;
  for (const EgoMotion& motion : motions) {
    if (motion.has_estimate()) {
      CHECK((reached_us == 0 || motion.utime_start_us == reached_us));
      reached_us = motion.utime_us;
    }
  }
  const Credibility front = credibility_of(motions, truth_of(simulated));
  CHECK(front.rmse_m() < 0.05);
}

TEST_CASE("A lost frame reported by the source spoils the scan that was open") {
  const Drive simulated = drive(scenario("straight"), default_radars(), options(5, 2.0));
  RecordingSink sink(2);
  Pipeline pipeline(configuration_of(simulated.radars), kNoSource, {&sink}, {});
  for (std::size_t i = 0; i < simulated.frames.size(); ++i) {
    if (i == simulated.frames.size() / 2) {
      pipeline.on_dropped(0);
    }
    pipeline.on_frame(simulated.frames[i]);
  }
  pipeline.finish();
  const auto is_dropped = [](const RadarScan& scan) {
    return scan.status == ScanStatus::dropped_frames;
  };
  CHECK(std::count_if(sink.scans[0].begin(), sink.scans[0].end(), is_dropped) == 1);
  CHECK(std::count_if(sink.scans[1].begin(), sink.scans[1].end(), is_dropped) == 0);
}

TEST_CASE("Silence is a gap, not a standing vehicle") {
  const Drive simulated = drive(scenario("silent"), default_radars(), options(5, 45.0));
  const RecordingSink sink = run_pipeline(simulated.radars, simulated.frames);
  check_invariants(sink);
  for (const auto& motions : sink.motions) {
    CHECK(count_status(motions, MotionStatus::gap_too_long) == 2);
  }
}

TEST_CASE("A clock that is set back costs one estimate and then goes on") {
  Drive simulated = drive(scenario("straight"), default_radars(), options(9, 6.0));
  for (std::size_t i = simulated.frames.size() / 2; i < simulated.frames.size(); ++i) {
    simulated.frames[i].stamp_us -= 3'600'000'000;
  }
  const RecordingSink sink = run_pipeline(simulated.radars, simulated.frames);
  check_invariants(sink);
  for (const auto& motions : sink.motions) {
    CHECK(count_status(motions, MotionStatus::gap_too_long) <= 1);
    CHECK(motions.back().has_estimate());
    CHECK(motions.back().utime_us < simulated.frames.front().stamp_us);
  }
  CHECK(sink.odometries.back().status == OdometryStatus::ok);
  CHECK(sink.odometries.back().utime_us < simulated.frames.front().stamp_us);
  // The status goes on at 1 Hz of the new time.
  CHECK(sink.statuses[0].size() >= 6);
}

TEST_CASE("Status at 1 Hz, and its counters add up") {
  const Drive simulated = drive(scenario("city"), default_radars(), options(2, 20.0));
  const RecordingSink sink = run_pipeline(simulated.radars, simulated.frames);
  for (std::size_t radar = 0; radar < 2; ++radar) {
    REQUIRE(sink.statuses[radar].size() >= 20);
    CHECK(sink.statuses[radar].size() <= 22);
    const RadarStatus& last = sink.statuses[radar].back();
    std::uint64_t motions = 0;
    for (const std::uint64_t count : last.motions_by_status) {
      motions += count;
    }
    CHECK(motions == last.assembler.scans);
    CHECK(motions == sink.motions[radar].size());
    std::uint64_t used = 0;
    for (const EgoMotion& motion : sink.motions[radar]) {
      used += static_cast<std::uint64_t>(motion.targets);
    }
    CHECK(used == last.selection.used);
    CHECK(last.decoder.frames == static_cast<std::uint64_t>(std::count_if(
                                     simulated.frames.begin(), simulated.frames.end(),
                                     [&](const CanFrame& f) { return f.interface == radar; })));
  }
}

TEST_CASE("Frames of two buses out of order by a moment do not multiply the status") {
  Drive simulated = drive(scenario("straight"), default_radars(), options(4, 5.0));
  for (std::size_t i = 1; i < simulated.frames.size(); i += 2) {
    if (simulated.frames[i].interface != simulated.frames[i - 1].interface) {
      std::swap(simulated.frames[i], simulated.frames[i - 1]);
    }
  }
  const RecordingSink sink = run_pipeline(simulated.radars, simulated.frames);
  CHECK(sink.statuses[0].size() <= 8);
}

TEST_CASE("Two buses whose clocks disagree by an hour do not disturb each other") {
  Drive simulated = drive(scenario("bends"), default_radars(), options(11, 5.0));
  const RecordingSink together = run_pipeline(simulated.radars, simulated.frames);
  for (CanFrame& frame : simulated.frames) {
    frame.stamp_us += frame.interface == 1 ? 3'600'000'000 : 0;
  }
  const RecordingSink apart = run_pipeline(simulated.radars, simulated.frames);
  for (std::size_t radar = 0; radar < 2; ++radar) {
    REQUIRE(apart.motions[radar].size() == together.motions[radar].size());
    CHECK(count_status(apart.motions[radar], MotionStatus::incomplete_scan) ==
          count_status(together.motions[radar], MotionStatus::incomplete_scan));
    CHECK(apart.motions[radar].back().motion == together.motions[radar].back().motion);
    // Frames of two clocks alternate: the time jumps back and forth.
    CHECK(apart.statuses[radar].size() >= 6);
    CHECK(apart.statuses[radar].size() <= 7);
  }
}

TEST_CASE("A bus whose clock is 100 ms ahead does not close the scans of others that agree") {
  Drive simulated = drive(scenario("bends"), one_of_each_kind(), options(11, 5.0));
  const RecordingSink together = run_pipeline(simulated.radars, simulated.frames);
  for (CanFrame& frame : simulated.frames) {
    frame.stamp_us += frame.interface == 1 ? 100'000 : 0;
  }
  const RecordingSink apart = run_pipeline(simulated.radars, simulated.frames);
  for (std::size_t radar = 0; radar < simulated.radars.size(); ++radar) {
    CAPTURE(radar);
    const AssemblerCounters& counters = apart.statuses[radar].back().assembler;
    CHECK(counters.scans == together.statuses[radar].back().assembler.scans);
    CHECK(counters.incomplete_scans == together.statuses[radar].back().assembler.incomplete_scans);
  }
}

TEST_CASE("Without a frame there is no status with an invented time") {
  CHECK(run_pipeline(default_radars(), {}).statuses[0].empty());
}
