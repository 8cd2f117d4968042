// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The odometry at a fixed rate, predicted between scans.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include <catch2/catch.hpp>

#include "daemon/output/odometry_writer.hpp"
#include "test/tools/pipeline_bench.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

constexpr int kRateHz = 50;
constexpr std::int64_t kPeriodUs = 20'000;

Drive simulate(const char* name, std::uint64_t seed, double duration_s = 12.0) {
  SimulationOptions options;
  options.seed = seed;
  options.duration_s = duration_s;
  return drive(scenario(name), default_radars(), options);
}

/// `before_frame`: called with the index of each frame before it.
using BeforeFrame = std::function<void(Pipeline&, std::size_t)>;

RecordingSink run(
    const Drive& drive, int rate_hz,
    const BeforeFrame& before_frame = [](Pipeline&, std::size_t) {}) {
  Configuration configuration = configuration_of(drive.radars);
  configuration.odometry.filter.rate_hz = rate_hz;
  RecordingSink sink(drive.radars.size());
  Pipeline pipeline(configuration, kNoSource, {&sink}, {});
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    before_frame(pipeline, i);
    pipeline.on_frame(drive.frames[i]);
  }
  pipeline.finish();
  return sink;
}

std::string rows(const RecordingSink& sink) {
  std::string text;
  for (const Odometry& odometry : sink.odometries) {
    text += odometry_csv_row(odometry).view();
  }
  return text;
}

bool is_good(const Odometry& odometry) {
  return odometry.status == OdometryStatus::ok || odometry.status == OdometryStatus::standing_still;
}

/// Silence on the buses.
void silence(Drive& drive, double begin_s, double end_s) {
  const std::int64_t start_us = drive.frames.front().stamp_us;
  const auto is_silent = [&](const CanFrame& frame) {
    const double time_s = static_cast<double>(frame.stamp_us - start_us) * 1e-6;
    return time_s > begin_s && time_s < end_s;
  };
  drive.frames.erase(std::remove_if(drive.frames.begin(), drive.frames.end(), is_silent),
                     drive.frames.end());
}

}  // namespace

TEST_CASE("Predicted odometry comes at each multiple of its period, once, and in order") {
  const Drive simulated = simulate("lossy", 4);
  const RecordingSink sink = run(simulated, kRateHz);
  REQUIRE(sink.odometries.size() > 550);
  for (std::size_t i = 0; i < sink.odometries.size(); ++i) {
    const Odometry& odometry = sink.odometries[i];
    CHECK(odometry.utime_us % kPeriodUs == 0);
    if (i > 0) {
      CHECK(odometry.utime_us - sink.odometries[i - 1].utime_us == kPeriodUs);
      CHECK(odometry.utime_before_us == sink.odometries[i - 1].utime_us);
    }
  }
  CHECK(sink.odometries.back().utime_us > simulated.frames.back().stamp_us - kPeriodUs);
}

TEST_CASE("A rate that is no divisor of a second keeps to its multiples too") {
  const RecordingSink sink = run(simulate("straight", 1, 4.0), 30);
  REQUIRE(sink.odometries.size() > 100);
  for (const Odometry& odometry : sink.odometries) {
    const double multiple = static_cast<double>(odometry.utime_us % 1'000'000) * 30e-6;
    CHECK(multiple - std::floor(multiple) < 30e-6);
  }
}

TEST_CASE("Predicted poses are as credible as those at scans, from anchor to anchor too",
          "[long]") {
  // Two paths: since the anchor, and from anchor to anchor, which is chained.
  Credibility since_anchor(3);
  Credibility chained(3);
  Credibility at_scans(3);
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Drive simulated = simulate(seed % 2 == 0 ? "bends" : "city", seed);
    const TrueTrajectory truth = truth_of(simulated);
    const auto add_to = [&](Credibility& sum, const Odometry& odometry) {
      const auto motion = truth.motion(odometry.utime_anchor_us, odometry.utime_us);
      if (is_good(odometry) && motion) {
        sum.add(odometry.pose, odometry.covariance, *motion);
      }
    };
    const RecordingSink sink = run(simulated, kRateHz);
    for (std::size_t i = 0; i < sink.odometries.size(); ++i) {
      const Odometry& odometry = sink.odometries[i];
      add_to(since_anchor, odometry);
      if (i + 1 < sink.odometries.size() &&
          sink.odometries[i + 1].utime_anchor_us != odometry.utime_anchor_us) {
        add_to(chained, odometry);
      }
    }
    for (const Odometry& odometry : run(simulated, 0).odometries) {
      add_to(at_scans, odometry);
    }
  }
  CAPTURE(since_anchor.anees(), chained.anees(), at_scans.anees());
  REQUIRE(since_anchor.count() > 1700);
  REQUIRE(chained.count() >= 16);
  CHECK(since_anchor.anees() < 1.3);
  CHECK(since_anchor.anees() > 0.15);
  CHECK(since_anchor.anees() < at_scans.anees() + 0.3);
  CHECK(chained.anees() < 1.5);
}

TEST_CASE("A predicted row of the time of a new anchor is the last that refers to the old") {
  const RecordingSink sink = run(simulate("bends", 2), kRateHz);
  int renewed = 0;
  for (std::size_t i = 1; i < sink.odometries.size(); ++i) {
    const Odometry& before = sink.odometries[i - 1];
    const Odometry& odometry = sink.odometries[i];
    if (is_good(before) && odometry.utime_anchor_us != before.utime_anchor_us) {
      ++renewed;
      CHECK(odometry.utime_anchor_us == before.utime_us);
      // In a step of 20 ms nothing jumps, and sigma is below that of 2 s of driving.
      CHECK(odometry.pose.norm() < 0.02 * (odometry.twist.norm() + 0.5));
      CHECK(odometry.covariance.trace() < 0.1 * before.covariance.trace());
      CHECK(odometry.odom_covariance.trace() > 0.9 * before.odom_covariance.trace());
    }
    CHECK((odometry.odom_pose - before.odom_pose).norm() < 0.02 * (odometry.twist.norm() + 8.0));
  }
  CHECK(renewed >= 3);
}

TEST_CASE("The motions between scans are the same whether or not there are predictions") {
  const Drive simulated = simulate("bends", 3);
  const RecordingSink without = run(simulated, 0);
  const RecordingSink with = run(simulated, kRateHz);
  REQUIRE(with.fused.size() == without.fused.size());
  for (std::size_t i = 0; i < with.fused.size(); ++i) {
    // Another anchor is another point of linearisation.
    CHECK(with.fused[i].utime_us == without.fused[i].utime_us);
    CHECK(with.fused[i].status == without.fused[i].status);
    if (!without.fused[i].has_estimate()) {
      continue;
    }
    const double std_m = std::sqrt(without.fused[i].covariance.trace());
    CHECK((with.fused[i].motion - without.fused[i].motion).norm() <= 0.05 * std_m);
  }
}

TEST_CASE(
    "Over a gap the rate is kept, what is told is called predicted, then lost; then silence") {
  Drive simulated = simulate("straight", 5);
  silence(simulated, 5.0, 9.0);
  const RecordingSink sink = run(simulated, kRateHz);
  const OdometryOptions options;
  const std::int64_t silent_us = simulated.frames.front().stamp_us + 5'000'000;
  std::int64_t last_scan_us = 0;
  for (const EgoMotion& motion : sink.fused) {
    last_scan_us = motion.utime_us < silent_us ? motion.utime_us : last_scan_us;
  }
  std::map<OdometryStatus, int> counts;
  double std_m = 0.0;
  std::int64_t last_us = 0;
  for (const Odometry& odometry : sink.odometries) {
    const double age_s = static_cast<double>(odometry.utime_us - last_scan_us) * 1e-6;
    if (age_s < 0.0 || age_s > 3.5) {
      continue;
    }
    ++counts[odometry.status];
    CHECK(age_s <= options.max_gap_s);
    CHECK((is_good(odometry) || age_s > options.predicted_s));
    CHECK((odometry.status == OdometryStatus::lost) == (age_s > options.lost_s));
    CHECK((last_us == 0 || odometry.utime_us - last_us == kPeriodUs));
    CHECK(odometry.odom_covariance.trace() > std_m);
    std_m = odometry.odom_covariance.trace();
    last_us = odometry.utime_us;
  }
  CHECK(counts[OdometryStatus::ok] >= 10);
  CHECK(counts[OdometryStatus::predicted] >= 36);
  CHECK(counts[OdometryStatus::lost] >= 49);
  CHECK(is_good(sink.odometries.back()));
}

TEST_CASE("Silence tells the time as frames do: live and replay give the same rows") {
  Drive simulated = simulate("lossy", 6);
  silence(simulated, 4.0, 4.4);
  silence(simulated, 7.0, 7.9);
  const std::string replayed = rows(run(simulated, kRateHz));
  REQUIRE(replayed.size() > 10'000);
  const std::string live = rows(run(simulated, kRateHz, [&](Pipeline& pipeline, std::size_t i) {
    const std::int64_t until_us = simulated.frames[i].stamp_us;
    const std::int64_t step_us = 700 + static_cast<std::int64_t>(i * 7919 % 20'000);
    const std::int64_t from_us = i == 0 ? until_us : simulated.frames[i - 1].stamp_us;
    for (std::int64_t now_us = from_us + step_us; now_us <= until_us; now_us += step_us) {
      pipeline.on_idle(now_us);
    }
  }));
  CHECK(live == replayed);
}

TEST_CASE("After the clock was set predictions go on in the new time") {
  const std::int64_t step_us = GENERATE(-3'600'000'000, 3'600'000'000);
  CAPTURE(step_us);
  Drive simulated = simulate("straight", 8, 6.0);
  const std::size_t middle = simulated.frames.size() / 2;
  const std::int64_t step_at_us = simulated.frames[middle].stamp_us;
  for (std::size_t i = middle; i < simulated.frames.size(); ++i) {
    simulated.frames[i].stamp_us += step_us;
  }
  const RecordingSink sink = run(simulated, kRateHz, [&](Pipeline& pipeline, std::size_t i) {
    if (i == middle) {
      pipeline.on_clock_step();
    }
  });
  const auto is_of_new_time = [&](const Odometry& odometry) {
    return step_us < 0 ? odometry.utime_us < step_at_us - 1'000'000
                       : odometry.utime_us > step_at_us + step_us;
  };
  const auto is_told = [&](const Odometry& odometry) {
    return is_good(odometry) && is_of_new_time(odometry);
  };
  CHECK(std::count_if(sink.odometries.begin(), sink.odometries.end(), is_told) > 100);
  CHECK(is_good(sink.odometries.back()));
  for (std::size_t i = 1; i < sink.odometries.size(); ++i) {
    const Eigen::Vector3d way = sink.odometries[i].odom_pose - sink.odometries[i - 1].odom_pose;
    CHECK(way.norm() < 2.0);
  }
}

TEST_CASE("The clock of a bus that is ahead does not tell the time of predictions") {
  Drive simulated = simulate("straight", 9);
  const std::int64_t start_us = simulated.frames.front().stamp_us;
  for (CanFrame& frame : simulated.frames) {
    frame.stamp_us += frame.interface == 1 ? 1'500'000 : 0;
  }
  const RecordingSink sink = run(simulated, kRateHz);
  std::ptrdiff_t told = 0;
  for (const Odometry& odometry : sink.odometries) {
    if (odometry.utime_us - start_us > 5'000'000) {
      CHECK(is_good(odometry));
      ++told;
    }
  }
  CHECK(told > 340);
}
