// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <functional>
#include <vector>

#include <catch2/catch.hpp>

#include "daemon/vehicle_listener.hpp"
#include "test/daemon/configuration_texts.hpp"

namespace cremed {
namespace {

TEST_CASE("Frames with a signal's identifier that cannot be read are counted, others are not") {
  struct Row {
    const char* name;
    std::function<void(CanFrame&)> change;
    bool is_read;
    std::uint64_t bad;
  };
  const std::vector<Row> rows = {
      {"good", [](CanFrame&) {}, true, 0},
      {"short", [](CanFrame& frame) { frame.length = 1; }, false, 1},
      {"remote", [](CanFrame& frame) { frame.remote = true; }, false, 1},
      {"FD", [](CanFrame& frame) { frame.fd = true; }, false, 1},
      {"extended", [](CanFrame& frame) { frame.extended = true; }, false, 0},
      {"error", [](CanFrame& frame) { frame.error = true; }, false, 0},
      {"other identifier", [](CanFrame& frame) { frame.id = 0x302; }, false, 0},
      {"other bus", [](CanFrame& frame) { frame.interface = 0; }, false, 0},
  };
  for (const Row& row : rows) {
    CAPTURE(row.name);
    VehicleListener listener(parse_configuration(
        kArs408 + "[vehicle]\ninterface = \"can1\"\nspeed = \"0x300\"\n", "test.toml"));
    CanFrame frame{.id = 0x300, .interface = 1, .length = 2, .data = {0x43, 0x20}};
    row.change(frame);
    const auto reading = listener.read(frame);
    CHECK(reading.has_value() == row.is_read);
    CHECK((!reading || reading->value == 16.0));
    CHECK(listener.bad_frames(VehicleSignal::speed) == row.bad);
  }
}

}  // namespace
}  // namespace cremed
