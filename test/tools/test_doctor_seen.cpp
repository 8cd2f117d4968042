// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/can_decoders/ars408.hpp"
#include "cremed/can_decoders/bosch_gpr.hpp"
#include "cremed/can_decoders/radar_family.hpp"
#include "tools/doctor/bus_observation.hpp"

using namespace cremed;

namespace {

/// `count` consecutive identifiers from `first`, each with frames of this length.
struct Ids {
  std::uint32_t first;
  std::uint32_t count;
  std::uint8_t length;
};

std::vector<std::string> seen(const std::vector<Ids>& traffic) {
  BusObservation bus;
  for (const Ids& ids : traffic) {
    for (std::uint32_t i = 0; i < ids.count; ++i) {
      bus.add({.id = ids.first + i, .length = ids.length});
    }
  }
  std::vector<std::string> names;
  for (const RadarSettings& radar : seen_radars(bus.traffic)) {
    names.push_back(radar.describe());
  }
  return names;
}

}  // namespace

TEST_CASE("Identifiers and lengths give radars away") {
  struct Case {
    std::string name;
    std::vector<Ids> traffic;
    std::vector<std::string> radars;
  };
  const auto row =
      GENERATE(Case{"nothing", {}, {}},
               Case{"a state report", {{0x201, 1, 8}}, {"an ARS408 with sensor id 0"}},
               Case{"a cluster list", {{0x610, 1, 5}}, {"an ARS408 with sensor id 1"}},
               Case{"an object list", {{0x67A, 1, 4}}, {"an ARS408 with sensor id 7"}},
               Case{"targets alone", {{0x701, 2, 8}}, {}},
               Case{"other lengths", {{0x201, 1, 7}, {0x600, 1, 8}, {0x60A, 1, 8}}, {}},
               Case{"a GPR", {{0x480, 96, 8}}, {"a Bosch GPR with base id 0x480"}},
               Case{"a GPR on identifiers of an ARS408",
                    {{0x200, 96, 8}},
                    {"a Bosch GPR with base id 0x200"}},
               Case{"two GPRs side by side",
                    {{0x200, 192, 8}},
                    {"a Bosch GPR with base id 0x200", "a Bosch GPR with base id 0x260"}},
               Case{"one identifier too few", {{0x480, 95, 8}}, {}},
               Case{"as many, but shorter", {{0x480, 96, 4}}, {}},
               Case{"both kinds",
                    {{0x300, 96, 8}, {0x630, 1, 5}},
                    {"a Bosch GPR with base id 0x300", "an ARS408 with sensor id 3"}});
  CAPTURE(row.name);
  CHECK(seen(row.traffic) == row.radars);
}

/// The content of a state report distinguishes an ARS408 from other devices with its identifier.
TEST_CASE("A state report names its sensor and comes once a second") {
  const auto names = [](std::uint8_t named_id, std::int64_t period_us) {
    BusObservation bus;
    for (int i = 0; i < 4; ++i) {
      CanFrame frame{.stamp_us = i * period_us, .id = 0x211, .length = 8};
      frame.data[4] = named_id;
      bus.add(frame);
    }
    return seen_radars(bus.traffic).size();
  };
  CHECK(names(1, 1'000'000) == 1);
  CHECK(names(1, 0) == 1);
  CHECK(names(1, 100'000) == 0);
  CHECK(names(2, 1'000'000) == 0);
}

TEST_CASE("Only classic data frames count") {
  BusObservation bus;
  bus.add({.id = 0x201, .length = 8, .extended = true});
  bus.add({.id = 0x201, .length = 8, .remote = true});
  bus.add({.id = 0x201, .length = 8, .fd = true});
  bus.add({.id = 0x201, .length = 8, .error = true});
  CHECK(seen_radars(bus.traffic).empty());
  CHECK(bus.foreign_frames == 3);
  CHECK(bus.status.frames == 3);
  CHECK(bus.status.error_frames == 1);
}

TEST_CASE("Keys to set") {
  CHECK(RadarSettings(Ars408Options{.sensor_id = 3}).key() == "sensor_id = 3");
  CHECK(RadarSettings(BoschGprOptions{.base_id = 0x260}).key() == "base_id = 0x260");
}
