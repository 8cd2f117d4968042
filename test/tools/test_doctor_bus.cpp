// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <linux/can/error.h>

#include "test/daemon/error_frame.hpp"
#include "test/tools/doctor_bench.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

/// Frames before a healthy drive, or instead of those of can0.
Observation with_errors(const Configuration& configuration, std::vector<CanFrame> errors,
                        bool only_errors) {
  Recording traffic = recording_of(configuration.radars);
  const std::int64_t begin_us = traffic.front().frame.stamp_us;
  if (only_errors) {
    remove_if(traffic, [](const BusFrame& entry) { return entry.interface == "can0"; });
  }
  for (CanFrame error : errors) {
    error.stamp_us = begin_us;
    traffic.insert(traffic.begin(), {"can0", error});
  }
  return observe(configuration, traffic);
}

BusObservation& front_bus(Observation& observation) { return observation.buses.front(); }

constexpr const char* kBitRate =
    "`ip link set can0 down; ip link set can0 up type can bitrate 500000 restart-ms 100`";

}  // namespace

TEST_CASE("What is wrong with a bus is found") {
  struct Case {
    std::string name;
    std::function<void(Observation&)> spoil;
    std::string what;
    std::string remedy;
  };
  const auto spoilt = GENERATE(
      Case{"no CAN in the kernel", [](auto& o) { o.kernel_has_can = false; },
           "the kernel has no CAN sockets", "`modprobe can_raw`"},
      Case{"absent", [](auto& o) { front_bus(o).state = InterfaceState::absent; },
           "there is no interface can0", "or set interface to an existing one: can1"},
      Case{"vcan absent",
           [](auto& o) {
             front_bus(o).state = InterfaceState::absent;
             front_bus(o).interface = "vcan0";
           },
           "there is no interface vcan0", "`ip link add vcan0 type vcan && ip link set vcan0 up`"},
      Case{"not in the log",
           [](auto& o) {
             front_bus(o).state = InterfaceState::absent;
             o.is_live = false;
           },
           "the log has no frame of interface can0",
           "record that bus too, or set interface to one of these: can1"},
      Case{"no CAN interface", [](auto& o) { front_bus(o).state = InterfaceState::not_can; },
           "can0 is no CAN interface", "`ip -brief link show type can`"},
      Case{"down", [](auto& o) { front_bus(o).state = InterfaceState::down; }, "can0 is down",
           "`ip link set can0 up type can bitrate 500000 restart-ms 100`"},
      Case{"vcan down",
           [](auto& o) {
             front_bus(o).state = InterfaceState::down;
             front_bus(o).interface = "vcan0";
           },
           "vcan0 is down", "`ip link set vcan0 up`"},
      Case{"bus-off", [](auto& o) { front_bus(o).state = InterfaceState::bus_off; },
           "can0 is bus-off", kBitRate},
      Case{"refused",
           [](auto& o) {
             front_bus(o).state = InterfaceState::failed;
             front_bus(o).error = "Operation not permitted";
           },
           "can0 cannot be read: Operation not permitted", "CAN sockets"},
      Case{"LCM", [](auto& o) { o.lcm_problem = "`ip route add 239.255.76.67/32 dev lo`"; },
           "LCM cannot send", "ip route add"});
  CAPTURE(spoilt.name);
  Configuration configuration = demo_configuration();
  Observation observation = observe(configuration, recording_of(configuration.radars));
  spoilt.spoil(observation);
  configuration.radars[0].interface = front_bus(observation).interface;
  const auto findings = diagnose(configuration, observation);
  check_first(findings, Severity::error, spoilt.what, spoilt.remedy);
  CHECK(findings.size() == 1);
}

TEST_CASE("Silence and error frames") {
  struct Case {
    std::string name;
    std::vector<CanFrame> errors;
    bool only_errors;
    Severity severity;
    std::string what;
    std::string remedy;
  };
  const auto spoilt = GENERATE(Case{"silence",
                                    {},
                                    true,
                                    Severity::error,
                                    "no frame on can0 in ",
                                    "`ip -details -statistics link show can0`"},
                               Case{"wrong bit rate, driver reports each error",
                                    {error_frame(CAN_ERR_PROT | CAN_ERR_BUSERROR)},
                                    true,
                                    Severity::error,
                                    "nothing but errors on can0",
                                    kBitRate},
                               Case{"wrong bit rate, driver reports changes of state",
                                    {error_frame(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE)},
                                    true,
                                    Severity::error,
                                    "nothing but errors on can0 (1 error frame): its bit rate",
                                    kBitRate},
                               Case{"some errors",
                                    {error_frame(CAN_ERR_PROT)},
                                    false,
                                    Severity::warning,
                                    "bus errors on can0 (1 error frame among ",
                                    "termination"},
                               Case{"error passive",
                                    {error_frame(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE)},
                                    false,
                                    Severity::warning,
                                    "bus errors on can0",
                                    "same bit rate"},
                               Case{"bus-off and back",
                                    {error_frame(CAN_ERR_RESTARTED), error_frame(CAN_ERR_BUSOFF)},
                                    false,
                                    Severity::warning,
                                    "can0 went bus-off 1 time",
                                    "restart-ms 100"},
                               Case{"nobody acknowledges",
                                    {error_frame(CAN_ERR_ACK)},
                                    false,
                                    Severity::warning,
                                    "no node acknowledges frames on can0",
                                    "cable"},
                               Case{"controller overrun",
                                    {error_frame(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW)},
                                    false,
                                    Severity::warning,
                                    "the controller of can0 lost frames 1 time",
                                    "adapter"});
  CAPTURE(spoilt.name);
  const Configuration configuration = demo_configuration();
  const Observation observation = with_errors(configuration, spoilt.errors, spoilt.only_errors);
  const auto findings = diagnose(configuration, observation);
  check_first(findings, spoilt.severity, spoilt.what, spoilt.remedy);
  CHECK(findings.size() == 1);
}

TEST_CASE("A controller that went bus-off and stayed so") {
  const Configuration configuration = demo_configuration();
  const Observation observation = with_errors(configuration, {error_frame(CAN_ERR_BUSOFF)}, true);
  const auto findings = diagnose(configuration, observation);
  check_first(findings, Severity::error, "nothing but errors on can0", kBitRate);
  CHECK_THAT(all_text(findings), Catch::Contains("can0 went bus-off 1 time"));
}

TEST_CASE("A report that all is well again is no finding") {
  const Configuration configuration = demo_configuration();
  const Observation observation =
      with_errors(configuration, {error_frame(CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE)}, false);
  CHECK(all_text(diagnose(configuration, observation)).empty());
}

TEST_CASE("Frames that the kernel dropped, and a receive buffer that it limits") {
  const Configuration configuration = demo_configuration();
  Observer observer(configuration);
  for (const BusFrame& entry : recording_of(configuration.radars)) {
    observer.add(entry.interface, entry.frame);
  }
  observer.add_lost("can0", 12);
  observer.bus("can1").status.receive_buffer_bytes = 212'992;
  observer.bus("can0").status.receive_buffer_bytes = 212'992;
  Observation observation = observer.finish();
  observation.is_live = true;
  const auto findings = diagnose(configuration, observation);
  check_first(findings, Severity::warning, "12 frames of can0 lost before",
              "`sysctl -w net.core.rmem_max=1048576`");
  REQUIRE(findings.size() == 2);
  CHECK(findings[1].severity == Severity::note);
  CHECK_THAT(findings[1].what, Catch::Contains("212992 bytes of receive buffer on can1"));

  // A limit that suffices is not lowered.
  for (BusObservation& bus : observation.buses) {
    bus.status.receive_buffer_bytes = 2 << 20;
  }
  CHECK_THAT(all_text(diagnose(configuration, observation)), !Catch::Contains("rmem_max"));
}

TEST_CASE("Errors come before warnings, whichever radar they are of") {
  const Configuration configuration = demo_configuration();
  Recording traffic = recording_of(configuration.radars);
  remove_if(traffic, [](const BusFrame& entry) { return entry.interface == "can1"; });
  Ars408RadarState state = good_state();
  state.interference = true;
  report_state(traffic, "can0", state);
  const auto findings = diagnose(configuration, observe(configuration, traffic));
  CAPTURE(all_text(findings));
  REQUIRE(findings.size() == 2);
  check_first(findings, Severity::error, "no frame on can1", "cable");
  CHECK(findings[1].severity == Severity::warning);
}
