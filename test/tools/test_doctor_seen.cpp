// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "tools/doctor/seen_radar.hpp"

using namespace cremed;

namespace {

/// `count` identifiers from `first` on, each with frames of this length.
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
  for (const SeenRadar& radar : seen_radars(bus)) {
    names.push_back(to_text(radar));
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

TEST_CASE("Only classic data frames count") {
  BusObservation bus;
  bus.add({.id = 0x201, .length = 8, .extended = true});
  bus.add({.id = 0x201, .length = 8, .remote = true});
  bus.add({.id = 0x201, .length = 8, .fd = true});
  bus.add({.id = 0x201, .length = 8, .error = true});
  CHECK(seen_radars(bus).empty());
  CHECK(bus.foreign_frames == 3);
  CHECK(bus.status.frames == 3);
  CHECK(bus.status.error_frames == 1);
}

TEST_CASE("Keys to set") {
  CHECK(key_of({SeenRadar::Kind::ars408, 3}) == "sensor_id = 3");
  CHECK(key_of({SeenRadar::Kind::bosch_gpr, 0x260}) == "base_id = 0x260");
}
