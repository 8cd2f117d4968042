// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Effects of live sources only: clock steps, silence, durations.
#include <algorithm>

#include <catch2/catch.hpp>

#include "test/tools/pipeline_bench.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

Drive straight(double duration_s) {
  SimulationOptions options;
  options.seed = 3;
  options.duration_s = duration_s;
  return drive(scenario("straight"), default_radars(), options);
}

std::int64_t stamp_clock_us = 0;
std::int64_t stamp_clock() { return stamp_clock_us; }

/// Each call advances it by 10 us.
std::int64_t busy_clock() {
  static std::int64_t now_us = 0;
  return now_us += 10;
}

/// Of the first radar since the start: that of the statuses, and of the scans since the last.
LatencySummary latency_of_all(const Pipeline& pipeline, RecordingSink& sink) {
  RadarChannel& front = *pipeline.radars()[0];
  front.begin_period();
  sink.on_status(0, front.status(0, kNoSource));
  LatencySummary all;
  for (const RadarStatus& status : sink.statuses[0]) {
    all.scans += status.latency.scans;
    all.max_us = std::max(all.max_us, status.latency.max_us);
  }
  return all;
}

class EndlessSource final : public FrameSource {
 public:
  explicit EndlessSource(std::vector<SourceEvent> events) : events_(std::move(events)) {}
  SourceEvent next(CanFrame& frame) override {
    frame.interface = 0;
    return at_ < events_.size() ? events_[at_++] : SourceEvent::end;
  }

 private:
  std::vector<SourceEvent> events_;
  std::size_t at_ = 0;
};

}  // namespace

TEST_CASE("No estimate spans a clock step, however small, and the next pair gives one again") {
  const std::int64_t step_us = GENERATE(50'000, -50'000, 3'600'000'000, -3'600'000'000);
  CAPTURE(step_us);
  Drive simulated = straight(4.0);
  const std::size_t middle = simulated.frames.size() / 2;
  const std::int64_t step_at_us = simulated.frames[middle].stamp_us;
  RecordingSink sink(2);
  Pipeline pipeline(configuration_of(simulated.radars), kNoSource, {&sink}, {});
  for (std::size_t i = 0; i < simulated.frames.size(); ++i) {
    if (i == middle) {
      pipeline.on_clock_step();
    }
    simulated.frames[i].stamp_us += i >= middle ? step_us : 0;
    pipeline.on_frame(simulated.frames[i]);
  }
  pipeline.finish();
  for (const auto& motions : sink.motions) {
    const auto last_before = std::find_if(motions.begin(), motions.end(), [&](const auto& motion) {
      return motion.status == MotionStatus::no_reference && &motion != &motions.front();
    });
    REQUIRE(last_before != motions.end());
    // Frames before it have the old time, frames after it the new.
    for (auto motion = motions.begin(); motion != last_before; ++motion) {
      CHECK(motion->utime_us < step_at_us);
    }
    for (auto motion = last_before; motion != motions.end(); ++motion) {
      CHECK(motion->utime_start_us >= step_at_us + step_us);
    }
    CHECK(count_status(motions, MotionStatus::no_reference) == 2);
    CHECK(motions.back().has_estimate());
    CHECK(count_status(motions, MotionStatus::incomplete_scan) == 0);
  }
}

TEST_CASE("On a silent bus scans still time out, and the status still comes once a second") {
  const Drive simulated = straight(1.0);
  RecordingSink sink(2);
  stamp_clock_us = simulated.frames.front().stamp_us;
  Pipeline pipeline(configuration_of(simulated.radars), kNoSource, {&sink}, {&stamp_clock, true});
  const auto header = std::find_if(simulated.frames.begin(), simulated.frames.end(),
                                   [](const CanFrame& frame) { return frame.id == 0x600; });
  pipeline.on_frame(*header);
  CHECK(sink.scans[0].empty());
  pipeline.on_idle(header->stamp_us + 20'000);
  CHECK(sink.scans[0].empty());
  pipeline.on_idle(header->stamp_us + 40'000);
  REQUIRE(sink.scans[0].size() == 1);
  CHECK(sink.motions[0][0].status == MotionStatus::too_few_targets);
  CHECK(sink.motions[0][0].incomplete);
  const std::size_t before = sink.statuses[0].size();
  for (int i = 1; i <= 250; ++i) {
    pipeline.on_idle(header->stamp_us + 40'000 + i * 20'000);
  }
  CHECK(sink.statuses[0].size() - before == 5);
}

TEST_CASE("Latency counts from the stamp of a scan's last frame, and is told once a second") {
  const Drive simulated = straight(3.0);
  RecordingSink sink(2);
  Pipeline pipeline(configuration_of(simulated.radars), kNoSource, {&sink}, {&stamp_clock, true});
  for (const CanFrame& frame : simulated.frames) {
    stamp_clock_us = frame.stamp_us + 700;  // Time of reading.
    pipeline.on_frame(frame);
  }
  pipeline.finish();
  REQUIRE(sink.statuses[0].size() >= 3);
  const LatencySummary& latency = sink.statuses[0][1].latency;
  CHECK(latency.scans >= 13);
  CHECK(latency.scans <= 15);
  CHECK(latency.max_us == 700);
  CHECK(latency.p50_us == 700);
  CHECK(latency_of_all(pipeline, sink).scans == sink.motions[0].size());
}

TEST_CASE("Without stamps of the clock, latency counts from when the last frame was handed in") {
  const Drive simulated = straight(1.0);
  RecordingSink sink(2);
  Pipeline pipeline(configuration_of(simulated.radars), kNoSource, {&sink}, {&busy_clock});
  for (const CanFrame& frame : simulated.frames) {
    pipeline.on_frame(frame);
  }
  // Calls: handed in, before and after the solver, before and after the odometry, published; at
  // most also before and after the odometry of a held scan of the other radar.
  CHECK(latency_of_all(pipeline, sink).max_us == 70);
  CHECK(sink.max_solve_us == 10);
}

TEST_CASE("Every event of a source but its end goes on") {
  EndlessSource source({SourceEvent::frame, SourceEvent::dropped, SourceEvent::clock_step,
                        SourceEvent::idle, SourceEvent::end});
  RecordingSink sink(2);
  Pipeline pipeline(configuration_of(default_radars()), source, {&sink}, {});
  int turns = 0;
  while (pipeline.take_next(source)) {
    ++turns;
  }
  CHECK(turns == 4);
}

TEST_CASE("A scan never closes earlier than the frames it is said to wait for allow") {
  SimulationOptions options;
  options.duration_s = 3.0;
  const Drive simulated = drive(scenario("lossy"), default_radars(), options);
  RecordingSink sink(2);
  Pipeline pipeline(configuration_of(simulated.radars), kNoSource, {&sink}, {});
  std::size_t most = 0;
  std::size_t whole = 0;
  for (const CanFrame& frame : simulated.frames) {
    const std::size_t awaited = pipeline.frames_to_next_scan();
    most = std::max(most, awaited);
    const std::size_t before[2] = {sink.scans[0].size(), sink.scans[1].size()};
    pipeline.on_frame(frame);
    for (std::size_t radar = 0; radar < 2; ++radar) {
      const auto& scans = sink.scans[radar];
      if (scans.size() > before[radar] && scans.back().status == ScanStatus::complete &&
          scans.back().count > 0) {
        ++whole;
        CHECK(awaited <= 1);  // This frame was the last one awaited.
      }
    }
  }
  CHECK(whole > 40);
  CHECK(most > 90);
}
