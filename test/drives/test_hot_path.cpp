// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <string_view>
#include <vector>

#include <catch2/catch.hpp>

#include "daemon/output/csv_writer.hpp"
#include "daemon/output/lcm_publisher.hpp"
#include "daemon/output/odometry_writer.hpp"
#include "daemon/output/tum_writer.hpp"
#include "daemon/source/can_socket.hpp"
#include "daemon/source/candump.hpp"
#include "test/daemon/datagram_pair.hpp"
#include "test/estimator/allocation_guard.hpp"
#include "test/tools/own_network.hpp"
#include "test/tools/pipeline_bench.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

Drive simulate() {
  SimulationOptions options;
  options.duration_s = 6.0;
  options.vehicle.interface = "can0";
  return drive(scenario("lossy"), default_radars(), options);
}

/// Text in, messages out, without allocation: every line of the log is parsed and passes both
/// radars' stages into the sinks. Returns the number of allocations.
long allocations_of_replay(const Drive& simulated, const std::vector<OdometrySink*>& sinks,
                           int rate_hz = 0) {
  Configuration configuration = configuration_of(simulated.radars);
  configuration.odometry.filter.rate_hz = rate_hz;
  configuration.vehicle.interface = "can0";
  configuration.odometry.filter.vehicle.speed.is_used = true;
  configuration.odometry.filter.vehicle.yaw_rate.is_used = true;
  Pipeline pipeline(configuration, kNoSource, sinks, {});
  const std::string log = simulated.log();
  std::string_view rest = log;
  const AllocationGuard guard;
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    CandumpLine line = parse_candump_line(rest.substr(0, end));
    line.frame.interface = line.interface_name == "can0" ? 0 : 1;
    pipeline.on_frame(line.frame);
    rest.remove_prefix(end + 1);
  }
  pipeline.finish();
  return AllocationGuard::stop();
}

/// Checks that the odometry filter was used.
class OdometryCounter final : public OdometrySink {
 public:
  void on_motion(std::size_t, const EgoMotion&, std::int32_t) override {}
  void on_odometry(const Odometry& odometry) override {
    good_odometries += odometry.is_usable() ? 1 : 0;
  }
  [[nodiscard]] std::uint64_t failures() const override { return 0; }

  int good_odometries = 0;
};

/// A sink that violates the rules.
class AllocatingSink final : public OdometrySink {
 public:
  void on_motion(std::size_t, const EgoMotion&, std::int32_t) override {
    kept_.push_back(std::vector<double>(3));
  }
  [[nodiscard]] std::uint64_t failures() const override { return 0; }
  [[nodiscard]] std::size_t calls() const { return kept_.size(); }

 private:
  std::vector<std::vector<double>> kept_;
};

}  // namespace

TEST_CASE("The guard fires: a sink that allocates is caught in the pipeline") {
  const Drive simulated = simulate();
  AllocatingSink sink;
  const long allocations = allocations_of_replay(simulated, {&sink});
  CHECK(sink.calls() > 100);
  CHECK(allocations >= static_cast<long>(sink.calls()));
}

TEST_CASE("From a line of text to ego-motions, odometry and trajectory, nothing allocates") {
  const Drive simulated = simulate();
  CsvWriter csv("/dev/null", {"front", "rear"});
  OdometryWriter odometry("/dev/null");
  TumWriter tum("/dev/null", std::nullopt);
  OdometryCounter counter;
  const int rate_hz = GENERATE(0, 50);
  CHECK(allocations_of_replay(simulated, {&csv, &odometry, &tum, &counter}, rate_hz) == 0);
  CHECK(counter.good_odometries > 100);
}

TEST_CASE("From a line of text to an LCM message on the wire, nothing allocates") {
  const Drive simulated = simulate();
  if (!enter_own_network()) {
    WARN("skipped: this system lets us have no network namespace of our own");
    return;
  }
  Configuration configuration = configuration_of(default_radars());
  configuration.output.publish_scans = true;
  configuration.output.nav_msgs_odometry = "/odometry#nav_msgs.Odometry";
  LcmPublisher publisher("udpm://239.255.76.67:7667?ttl=0", configuration);
  REQUIRE(publisher.connect().empty());
  CHECK(allocations_of_replay(simulated, {&publisher}) == 0);
  CHECK(publisher.failures() == 0);
}

TEST_CASE("From a socket to CSV, nothing allocates") {
  const Drive simulated = simulate();
  CsvWriter csv("/dev/null", {"front", "rear"});
  Pipeline pipeline(configuration_of(simulated.radars), kNoSource, {&csv}, {});
  const DatagramPair pair;
  CanSocket socket;
  REQUIRE(socket.adopt(pair.receiver(), {}).error == 0);
  std::size_t received = 0;
  long allocations = 0;
  for (const CanFrame& frame : simulated.frames) {
    can_frame raw{};
    raw.can_id = frame.id;
    raw.can_dlc = frame.length;
    std::memcpy(raw.data, frame.data.data(), sizeof(raw.data));
    pair.send(&raw, sizeof(raw));
    const AllocationGuard guard;
    for (const ReceivedFrame& read : socket.receive().frames) {
      CanFrame stamped = read.frame;
      stamped.stamp_us = frame.stamp_us;
      stamped.interface = frame.interface;
      pipeline.on_frame(stamped);
      ++received;
    }
    allocations += AllocationGuard::stop();
  }
  CHECK(received == simulated.frames.size());
  CHECK(allocations == 0);
}
