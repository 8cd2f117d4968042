// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/can_decoders/bosch_gpr_signals.hpp"
#include "test/can_decoders/hex_frame.hpp"
#include "test/tools/simulated_drive.hpp"
#include "tools/simulate/can_bus.hpp"

namespace {

using cremed::Ars408Options;
using cremed::BoschGprOptions;
using cremed::CanFrame;
using cremed::RadarConfiguration;
using cremed::test::Drive;
using cremed::test::radar;

/// Two ARS408 on one bus, two GPR on another, and one of each on a third.
std::vector<RadarConfiguration> shared_buses() {
  Ars408Options second;
  second.sensor_id = 1;
  BoschGprOptions upper;
  upper.base_id = 0x480;
  upper.info_id = 0x101;
  return {radar("front", "can0", {3.5, 0.0, 0.0}, Ars408Options{}),
          radar("back", "can0", {-1.0, 0.0, 3.1}, second),
          radar("left", "can1", {2.0, 0.9, 1.5}, BoschGprOptions{}),
          radar("right", "can1", {2.0, -0.9, -1.5}, upper),
          radar("corner", "can2", {3.4, 0.8, 0.7}, Ars408Options{}),
          radar("rear", "can2", {-0.9, 0.0, 3.0}, upper)};
}

Drive short_drive(const char* scenario, const std::vector<RadarConfiguration>& radars,
                  std::uint64_t seed = 1, double duration_s = 20.0) {
  cremed::SimulationOptions options;
  options.seed = seed;
  options.duration_s = duration_s;
  return cremed::test::drive(cremed::test::scenario(scenario), radars, options);
}

/// Bits of a classic data frame and the gap after it, without any stuff bit, at 2 us each.
std::int64_t least_frame_time_us(const CanFrame& frame) {
  return std::int64_t{2} * (47 + 8 * frame.length);
}

bool is_clean(const cremed::test::DecodedRadar& decoded) {
  const auto& d = decoded.decoder;
  const auto& a = decoded.assembler;
  return d.wrong_length + d.wrong_kind + d.wrong_mode + d.wrong_slot + d.crc_errors +
             d.counter_errors + a.incomplete_scans + a.timeouts + a.missing_parts +
             a.duplicate_parts + a.conflicting_parts + a.reordered_parts + a.excess_parts +
             a.orphan_parts + a.repeated_scans + a.missed_scans + a.stamps_backwards ==
         0;
}

/// Requests the bus at given times.
class ScriptedSender : public cremed::BusSender {
 public:
  ScriptedSender(std::vector<std::int64_t> times_us, const CanFrame& frame)
      : times_us_(std::move(times_us)), frame_(frame) {}

  [[nodiscard]] cremed::FrameRequest request() const override {
    if (next_ == times_us_.size()) return {};
    return {times_us_[next_], frame_.id, frame_.length};
  }
  CanFrame send(std::int64_t /*stamp_us*/) override {
    ++next_;
    return frame_;
  }

 private:
  std::vector<std::int64_t> times_us_;
  CanFrame frame_;
  std::size_t next_ = 0;
};

}  // namespace

TEST_CASE("the smallest identifier that waits gets the bus, and never interrupts a frame") {
  cremed::CanBus bus(5);
  bus.attach(std::make_unique<ScriptedSender>(std::vector<std::int64_t>{0, 0, 0},
                                              cremed::test::hex_frame("701#0000000000000000")));
  bus.attach(std::make_unique<ScriptedSender>(std::vector<std::int64_t>{100},
                                              cremed::test::hex_frame("201#0000000000000000")));
  bus.attach(std::make_unique<ScriptedSender>(std::vector<std::int64_t>{10'000},
                                              cremed::test::hex_frame("600#0000000000")));
  std::vector<std::pair<std::int64_t, std::uint32_t>> sent;
  while (bus.next_stamp_us() != cremed::FrameRequest::kNeverUs) {
    const CanFrame frame = bus.transmit();
    CHECK(frame.interface == 5);
    sent.emplace_back(frame.stamp_us, frame.id);
  }
  const std::vector<std::pair<std::int64_t, std::uint32_t>> expected{
      {249, 0x701}, {498, 0x201}, {747, 0x701}, {996, 0x701}, {10'195, 0x600}};
  CHECK(sent == expected);
}

TEST_CASE("frames of a drive are in order, and those of one bus never overlap") {
  const char* scenario = GENERATE("city", "standing", "lossy");
  const Drive drive = short_drive(scenario, shared_buses());
  std::map<unsigned, std::int64_t> last_on_bus;
  std::int64_t last_us = 0;
  for (const CanFrame& frame : drive.frames) {
    REQUIRE(frame.stamp_us >= last_us);
    last_us = frame.stamp_us;
    REQUIRE(frame.interface < 3);
    const auto found = last_on_bus.find(frame.interface);
    if (found != last_on_bus.end()) {
      REQUIRE(frame.stamp_us - found->second >= least_frame_time_us(frame));
    }
    last_on_bus[frame.interface] = frame.stamp_us;
  }
  CHECK(last_on_bus.size() == 3);
}

TEST_CASE("radars that share a bus all get their whole scans through, in their rhythm") {
  const Drive drive = short_drive("city", shared_buses());
  const std::string log = drive.log();
  for (const RadarConfiguration& one : drive.radars) {
    CAPTURE(one.name);
    const bool is_gpr = one.decoder.as<BoschGprOptions>() != nullptr;
    const auto decoded = cremed::test::decode(log, one);
    CHECK(is_clean(decoded));
    CHECK(decoded.decoder.state_frames >= (is_gpr ? 19U : 38U));
    REQUIRE(decoded.scans.size() > (is_gpr ? 190U : 260U));
    // The first frame of a list waits for the frame on the bus; an ARS408 also waits for the whole
    // list of a GPR, whose identifiers are smaller.
    const std::int64_t delay_us = one.name == "corner" ? 25'000 : 1'000;
    const std::int64_t least_us = (is_gpr ? 99'000 : 72'000) - delay_us;
    const std::int64_t greatest_us = (is_gpr ? 101'000 : 75'000) + delay_us;
    for (std::size_t i = 1; i < decoded.scans.size(); ++i) {
      const auto& before = decoded.scans[i - 1];
      const auto& scan = decoded.scans[i];
      REQUIRE(scan.stamp_us - before.stamp_us >= least_us);
      REQUIRE(scan.stamp_us - before.stamp_us <= greatest_us);
      const std::uint16_t step = static_cast<std::uint16_t>(scan.counter - before.counter);
      if (is_gpr) {
        REQUIRE((step & 3U) == 1U);
      } else {
        REQUIRE(step == 2U);
      }
    }
  }
}

TEST_CASE("a list comes back to back and state frames fall inside lists") {
  const Drive drive = short_drive("city", {radar("front", "can0", {}, Ars408Options{})}, 1, 60.0);
  const auto in_list = [](const CanFrame& frame) { return frame.id == 0x701 || frame.id == 0x702; };
  std::size_t inside = 0;
  std::size_t state_frames = 0;
  double gaps_us = 0.0;
  std::size_t gaps = 0;
  for (auto frame = drive.frames.begin() + 1; frame != drive.frames.end(); ++frame) {
    const CanFrame& before = *(frame - 1);
    if (frame->id == 0x201) {
      ++state_frames;
      const auto next = std::find_if(frame, drive.frames.end(), [](const CanFrame& other) {
        return other.id != 0x201 && other.id != 0x700;
      });
      if (next != drive.frames.end() && in_list(before) && in_list(*next)) ++inside;
    }
    if (before.id == 0x701 && frame->id == 0x701) {
      gaps_us += static_cast<double>(frame->stamp_us - before.stamp_us);
      ++gaps;
    }
  }
  CHECK(state_frames == 60);
  CHECK(inside >= 10);
  CHECK(inside < state_frames);
  REQUIRE(gaps > 10'000);
  CHECK(gaps_us / static_cast<double>(gaps) == Approx(250.0).margin(5.0));
}

TEST_CASE("no radar sends more targets than it can, and the nearest are first") {
  const auto radars = cremed::test::one_of_each_kind();
  const std::vector<std::size_t> limits{125, 48, 100, 48};
  for (const char* scenario : {"straight", "city"}) {
    const Drive drive = short_drive(scenario, radars, 2, 60.0);
    const std::string log = drive.log();
    for (std::size_t i = 0; i < radars.size(); ++i) {
      CAPTURE(scenario, radars[i].name);
      std::size_t most = 0;
      for (const auto& scan : cremed::test::decode(log, radars[i]).scans) {
        most = std::max<std::size_t>(most, scan.count);
        for (std::size_t k = 1; k < scan.count; ++k) {
          // Rounding to the grid of 0.2 m may swap neighbours.
          REQUIRE(scan.detections[k].range_m > scan.detections[k - 1].range_m - 0.3);
        }
      }
      CHECK(most <= limits[i]);
      CHECK(most >= 40);
    }
  }
}

TEST_CASE("a GPR frame says how old its measurement is") {
  const Drive drive = short_drive("standing", {radar("gpr", "can0", {}, BoschGprOptions{})});
  std::int64_t scan_us = 0;
  std::size_t count = 0;
  for (const CanFrame& frame : drive.frames) {
    if (frame.id == 0x200) scan_us = frame.stamp_us;
    if (frame.id < 0x200 || frame.id % 2 == 0) continue;
    const auto target =
        cremed::decode_bosch_gpr<cremed::BoschGprTargetB>(cremed::test::bytes_of(frame));
    const auto age_us = static_cast<double>(frame.stamp_us - scan_us);
    REQUIRE(1e6 * target->age_s == Approx(age_us).margin(51.0));
    ++count;
  }
  CHECK(count == std::size_t{200} * 48);
}

TEST_CASE("a lossy bus loses one frame in a thousand, and some scans with them") {
  const auto radars = cremed::default_radars();
  const Drive whole = short_drive("city", radars, 3, 60.0);
  const Drive lossy = short_drive("lossy", radars, 3, 60.0);
  const auto lost = static_cast<double>(whole.frames.size() - lossy.frames.size());
  CHECK(lost / static_cast<double>(whole.frames.size()) == Approx(1e-3).margin(3e-4));
  const auto decoded = cremed::test::decode(lossy.log(), radars[0]);
  CHECK(decoded.assembler.incomplete_scans > 0);
  CHECK(decoded.assembler.incomplete_scans < decoded.assembler.scans / 4);
}

TEST_CASE("silent radars go on counting") {
  const Drive drive = short_drive("silent", cremed::default_radars(), 1, 60.0);
  const auto decoded = cremed::test::decode(drive.log(), drive.radars[0]);
  int silences = 0;
  for (std::size_t i = 1; i < decoded.scans.size(); ++i) {
    const auto gap_us =
        static_cast<double>(decoded.scans[i].stamp_us - decoded.scans[i - 1].stamp_us);
    if (gap_us < 100e3) continue;
    ++silences;
    CHECK(gap_us == Approx(2e6).margin(150e3));
    const std::uint16_t step =
        static_cast<std::uint16_t>(decoded.scans[i].counter - decoded.scans[i - 1].counter);
    CHECK(step == Approx(2.0 * gap_us / 73.5e3).margin(2.0));
  }
  CHECK(silences == 2);
}
