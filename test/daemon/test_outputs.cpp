// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause

#include <catch2/catch.hpp>

#include "daemon/output/outputs.hpp"

using namespace cremed;

namespace {

constexpr std::int64_t kMaxAgeUs = 500'000;

std::int64_t time_us = 0;
std::int64_t now_us() { return time_us; }

/// Counts what it gets, and takes a while for each.
class SlowSink final : public OdometrySink {
 public:
  explicit SlowSink(std::int64_t takes_us = 0) : takes_us_(takes_us) {}
  void on_scan(std::size_t, const RadarScan&) override { take(); }
  void on_motion(std::size_t, const EgoMotion&, std::int32_t) override { take(); }
  void on_odometry(const Odometry&) override { take(); }
  void on_fused(const EgoMotion&, std::int32_t) override { take(); }
  void on_status(std::size_t, const RadarStatus&) override { take(); }

  int taken = 0;

 private:
  void take() {
    ++taken;
    time_us += takes_us_;
  }
  std::int64_t takes_us_;
};

/// A scan, a motion, an odometry and a fused motion, all of one time.
void send_all(OdometrySink& sink, std::int64_t utime_us) {
  RadarScan scan;
  scan.stamp_us = utime_us;
  EgoMotion motion;
  motion.utime_us = utime_us;
  Odometry odometry;
  odometry.utime_us = utime_us;
  sink.on_scan(0, scan);
  sink.on_motion(0, motion, 0);
  sink.on_odometry(odometry);
  sink.on_fused(motion, 0);
}

}  // namespace

TEST_CASE("All that is measured passes until it is too old, and is counted after") {
  SlowSink sink;
  Outputs outputs({&sink}, kMaxAgeUs, &now_us);
  time_us = 10'000'000;
  send_all(outputs, time_us - kMaxAgeUs);
  CHECK(sink.taken == 4);
  CHECK(outputs.failures() == 0);
  send_all(outputs, time_us - kMaxAgeUs - 1);
  CHECK(sink.taken == 4);
  CHECK(outputs.failures() == 4);
}

TEST_CASE("In a replay nothing is too old") {
  SlowSink sink;
  Outputs outputs({&sink}, std::nullopt, &now_us);
  time_us = 10'000'000;
  send_all(outputs, 0);
  CHECK(sink.taken == 4);
  CHECK(outputs.failures() == 0);
}

TEST_CASE("Each sink is judged when it is its turn") {
  SlowSink slow(kMaxAgeUs + 1);
  SlowSink last;
  Outputs outputs({&slow, &last}, kMaxAgeUs, &now_us);
  EgoMotion motion;
  motion.utime_us = time_us;
  outputs.on_motion(0, motion, 0);
  CHECK(slow.taken == 1);
  CHECK(last.taken == 0);
  CHECK(outputs.failures() == 1);
}

TEST_CASE("A status always passes, and what is stamped after a clock that was set back") {
  SlowSink sink;
  Outputs outputs({&sink}, kMaxAgeUs, &now_us);
  RadarStatus status;
  status.utime_us = time_us - 10 * kMaxAgeUs;
  outputs.on_status(0, status);
  send_all(outputs, time_us + 10 * kMaxAgeUs);
  CHECK(sink.taken == 5);
}
