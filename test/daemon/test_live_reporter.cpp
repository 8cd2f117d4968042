// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The line for `systemctl status`, and the log. UDP replaces CAN; the clock stands still, so that
// nothing looks for the interface.
#include <csignal>
#include <sstream>
#include <string>
#include <utility>

#include <catch2/catch.hpp>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include "cremed/can_decoders/ars408_commands.hpp"
#include "daemon/configuration/interfaces.hpp"
#include "daemon/live_reporter.hpp"
#include "daemon/process/clocks.hpp"
#include "test/daemon/datagram_pair.hpp"
#include "test/daemon/moved_clock.hpp"

using namespace cremed;
using cremed::test::DatagramPair;

namespace {

Configuration one_told_radar() {
  Configuration configuration;
  RadarConfiguration radar;
  radar.name = "front";
  radar.interface = "absent";
  radar.decoder = Ars408Options{.motion_feedback = true};
  configuration.radars.push_back(radar);
  configuration.odometry.enabled = false;
  configuration.live.max_latency_s = 60.0;  // However busy the computer is.
  return configuration;
}

class ReporterBench {
 public:
  explicit ReporterBench(Configuration configuration = one_told_radar())
      : configuration_(std::move(configuration)) {
    spdlog::set_default_logger(std::make_shared<spdlog::logger>(
        "test", std::make_shared<spdlog::sinks::ostream_sink_st>(log_)));
    spdlog::set_pattern("%l %v");
  }
  void connect() { source_.interfaces()[0]->adopt(bus_.receiver()); }
  void send(canid_t id, int count = 1) {
    for (int i = 0; i < count; ++i) {
      bus_.send(id, 8);
    }
  }

  /// Reads what was sent, and reports.
  std::string report() {
    CanFrame frame;
    // A busy kernel may deliver after the first silence.
    for (int silences = 0; silences < 2;) {
      const SourceEvent event = source_.next(frame);
      silences += event == SourceEvent::idle ? 1 : 0;
      if (event == SourceEvent::frame) {
        feedback_.hear(frame);
      }
      pipeline_.on_event(event, frame);
    }
    return reporter_.report();
  }
  [[nodiscard]] std::string log() const { return log_.str(); }

 private:
  std::ostringstream log_;
  volatile std::sig_atomic_t stop_ = 0;
  DatagramPair bus_;
  Configuration configuration_;
  LiveSource source_{configuration_, &stop_};
  Pipeline pipeline_{configuration_, source_, {}, PipelineClock{&realtime_us, true}};
  MotionFeedback feedback_{configuration_, source_};
  LiveReporter reporter_{configuration_, pipeline_, source_, feedback_, nullptr};
};

}  // namespace

TEST_CASE("The line names the state of the bus, and what follows from it only if that is well") {
  ReporterBench bench;
  CHECK_THAT(bench.report(), Catch::StartsWith("front: absent "));
  bench.connect();
  CHECK(bench.report() == "front: absent is silent");
  bench.send(CAN_ERR_FLAG | 0x80);  // CAN_ERR_BUSERROR.
  // An error frame is an idle event too.
  CHECK(bench.report() == "front: absent has errors only");
  bench.send(0x201);  // Begins no scan, which would end some time later.
  CHECK(bench.report() == "front: 0 scans/s, 0 estimates/s");
  CHECK(bench.report() == "front: absent is silent");
}

TEST_CASE("The line names another node that tells the sensor its motion") {
  ReporterBench bench;
  bench.connect();
  bench.send(0x201);
  CHECK(bench.report() == "front: 0 scans/s, 0 estimates/s");
  bench.send(encode_ars408_speed(0, 1.0).id);
  CHECK(bench.report() ==
        "front: 0 scans/s, 0 estimates/s, motion_feedback paused: another node sends it");
}

TEST_CASE("A clock that was set is told once, though no radar is found on the first interface") {
  Configuration configuration = one_told_radar();
  configuration.radars.insert(configuration.radars.begin(), configuration.radars.front());
  configuration.radars.front().name = "rear";
  configuration.radars.front().interface = kAutoInterface;
  ReporterBench bench(configuration);
  bench.report();
  CHECK_THAT(bench.log(), !Catch::Contains("the clock was set"));
  test::is_clock_set = true;
  for (int i = 0; i < 3; ++i) {
    bench.report();
  }
  const std::string told = "warning the clock was set: odometry restarts\n";
  CHECK_THAT(bench.log(), Catch::Contains(told));
  CHECK(bench.log().find(told) == bench.log().rfind(told));
}

TEST_CASE("A radar that has its interface's name is told apart from it in the log") {
  Configuration configuration = one_told_radar();
  configuration.radars.front().name = configuration.radars.front().interface;
  ReporterBench bench(configuration);
  bench.connect();
  for (int i = 0; i < 6; ++i) {
    bench.send(0x201);
    bench.report();
  }
  CHECK_THAT(bench.log(), Catch::Contains("warning radar absent: no scans"));
  CHECK_THAT(bench.log(), !Catch::Contains("good again"));
}

TEST_CASE("A signal of the vehicle that never comes is lost, though the radars are silent too") {
  Configuration configuration = one_told_radar();
  configuration.odometry.enabled = true;
  configuration.vehicle.interface = "absent";
  configuration.odometry.filter.vehicle.speed.is_used = true;
  configuration.odometry.filter.vehicle.yaw_rate.is_used = true;
  ReporterBench bench(configuration);
  bench.connect();
  CHECK_THAT(bench.report(), Catch::Contains("vehicle speed: ok; vehicle yaw rate: ok"));
  test::realtime_ahead_us += 1'000'000;
  CHECK_THAT(bench.report(), Catch::Contains("vehicle speed: lost; vehicle yaw rate: lost"));
  CHECK_THAT(bench.log(), Catch::Contains("warning vehicle speed: no frame 0x300 on absent"));
}
