// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/can_decoders/ars408.hpp"
#include "cremed/can_decoders/bosch_gpr.hpp"
#include "cremed/can_decoders/scan_assembler.hpp"
#include "test/can_decoders/gpr_frames.hpp"
#include "test/can_decoders/hex_frame.hpp"
#include "test/can_decoders/scan_bench.hpp"

namespace cremed::test {
namespace {

/// One radar on a bus, as the daemon runs it.
template <class Decoder, class Options>
struct Radar {
  explicit Radar(const Options& options) : decoder(options) {}

  void receive(const CanFrame& frame) {
    assembler.add(decoder.decode(frame));
    while (const RadarScan* scan = assembler.next()) {
      scans.push_back(*scan);
    }
  }

  Decoder decoder;
  ScanAssembler assembler{decoder, kTimeoutUs};
  std::vector<RadarScan> scans;
};

using Ars408 = Radar<Ars408Decoder, Ars408Options>;
using Gpr = Radar<BoschGprDecoder, BoschGprOptions>;

TEST_CASE("Two clusters on the bus are two detections") {
  Ars408 radar({});
  std::int64_t stamp_us = 500;
  for (const char* frame : {"600#0101581110", "701#004E81FC80200147", "701#1155F9E172A0C191",
                            "702#00859A9A03", "702#116C155103"}) {
    radar.receive(hex_frame(frame, stamp_us += 250));
  }
  REQUIRE(radar.scans.size() == 1);
  const RadarScan& scan = radar.scans[0];
  CHECK(scan.status == ScanStatus::complete);
  CHECK(scan.stamp_us == 750);
  CHECK(scan.counter == 0x5811);
  REQUIRE(scan.count == 2);
  CHECK(scan.detections[0].range_m == Approx(std::hypot(2.4, -0.7)));
  CHECK(scan.detections[1].id == 17);
  CHECK(scan.detections[1].validity == Validity::usable);
  CHECK(scan.detections[1].azimuth_rad == Approx(std::atan2(-6.1, 50.2)));
}

TEST_CASE("State and foreign frames inside a list do not end it") {
  Ars408 radar({});
  for (const char* frame : {"600#0200000110", "201#4019000010180000", "701#004E81FC80200147",
                            "700#041E0200", "123#DEADBEEF", "701#1155F9E172A0C191",
                            "702#00859A9A03", "611#00", "201#4019000010180000", "702#116C155103"}) {
    radar.receive(hex_frame(frame));
  }
  REQUIRE(radar.scans.size() == 1);
  CHECK(radar.scans[0].status == ScanStatus::complete);
  CHECK(radar.scans[0].count == 2);
  CHECK(radar.decoder.counters().state_frames == 3);
}

TEST_CASE("Two sensors interleaved on one bus keep their own scans") {
  Ars408 front({.sensor_id = 0});
  Ars408 rear({.sensor_id = 2});
  const std::vector<std::string> bus = {
      "600#0200000110",       "620#0100770710", "701#004E81FC80200147",
      "721#0055F9E172A0C191", "722#006C155103", "701#1155F9E172A0C191",
      "620#0000770910",       "702#00859A9A03", "702#116C155103"};
  for (const std::string& frame : bus) {
    front.receive(hex_frame(frame));
    rear.receive(hex_frame(frame));
  }
  REQUIRE(front.scans.size() == 1);
  CHECK(front.scans[0].status == ScanStatus::complete);
  CHECK(front.scans[0].counter == 1);
  CHECK(front.scans[0].count == 2);
  REQUIRE(rear.scans.size() == 2);
  CHECK(rear.scans[0].status == ScanStatus::complete);
  CHECK(rear.scans[0].counter == 0x7707);
  CHECK(rear.scans[0].count == 1);
  CHECK(rear.scans[1].count == 0);
  for (const Ars408* radar : {&front, &rear}) {
    CHECK(radar->assembler.counters().orphan_parts == 0);
    CHECK(radar->assembler.counters().conflicting_parts == 0);
  }
}

TEST_CASE("Without quality messages no scan is whole, and the state says why") {
  Ars408 radar({});
  for (const char* frame : {"201#4019000010080000", "600#0200000110", "701#004E81FC80200147",
                            "701#1155F9E172A0C191", "600#0000000310"}) {
    radar.receive(hex_frame(frame));
  }
  CHECK(radar.scans.at(0).status == ScanStatus::missing_parts);
  CHECK(radar.assembler.counters().missing_parts == 2);
  CHECK_FALSE(radar.decoder.radar_state()->sends_quality);
}

TEST_CASE("A frame cut short leaves its scan without a part") {
  Ars408 radar({});
  for (const char* frame : {"600#0100000110", "701#004E81FC802001", "702#00859A9A03"}) {
    radar.receive(hex_frame(frame));
  }
  radar.assembler.finish();
  CHECK(radar.assembler.next()->status == ScanStatus::missing_parts);
  CHECK(radar.assembler.counters().reordered_parts == 1);
}

TEST_CASE("A GPR's measured slots are the detections of its scan") {
  Gpr radar({});
  std::int64_t stamp_us = 0;
  for (unsigned scan = 0; scan < 6; ++scan) {
    for (unsigned slot = 0; slot < 48; ++slot) {
      for (const bool is_a : {true, false}) {
        const GprFrame frame{
            .slot = slot, .is_a = is_a, .counter = scan % 4, .measured = slot % 3 == 0};
        radar.receive(frame.at(stamp_us += 250));
      }
    }
    stamp_us += 76'000;
  }
  REQUIRE(radar.scans.size() == 6);
  for (const RadarScan& scan : radar.scans) {
    CHECK(scan.status == ScanStatus::complete);
    CHECK(scan.announced == 48);
    CHECK(scan.count == 16);
    CHECK(scan.detections[1].id == 3);
    CHECK(scan.detections[1].range_m == 10.0);
  }
  CHECK(radar.assembler.counters().missed_scans == 0);
  CHECK(radar.decoder.counters().counter_errors == 0);
}

TEST_CASE("Targets of a GPR are numbered by slot, whatever it calls them") {
  Gpr radar({});
  for (unsigned slot = 0; slot < 48; ++slot) {
    radar.receive(GprFrame{.slot = slot, .own_id = 0}.at());
    radar.receive(GprFrame{.slot = slot, .is_a = false, .own_id = 0}.at());
  }
  REQUIRE(radar.scans.size() == 1);
  CHECK(radar.scans[0].detections[47].id == 47);
}

}  // namespace
}  // namespace cremed::test
