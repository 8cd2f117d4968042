// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "tools/doctor/can_interfaces.hpp"
#include "tools/eval/temporary_folder.hpp"

using namespace cremed;

namespace {

/// An interface as /sys/class/net shows it; an empty text: no such file.
struct SysInterface {
  std::string name;
  std::string type;
  std::string flags;
  std::string carrier;
  bool has_device;
};

void write(const std::string& path, const std::string& text) {
  if (!text.empty()) {
    std::ofstream(path) << text << '\n';
  }
}

void make(const TemporaryFolder& sys, const SysInterface& interface) {
  const std::string folder = sys.file(interface.name);
  std::filesystem::create_directory(folder);
  write(folder + "/type", interface.type);
  write(folder + "/flags", interface.flags);
  write(folder + "/carrier", interface.carrier);
  if (interface.has_device) {
    std::filesystem::create_directory(folder + "/device");
  }
}

}  // namespace

TEST_CASE("The state of an interface is what the kernel shows") {
  struct Case {
    SysInterface interface;
    InterfaceState state;
    bool is_virtual;
  };
  const auto row =
      GENERATE(Case{{"can0", "280", "0x400c1", "1", true}, InterfaceState::up, false},
               Case{{"vcan0", "280", "0xc1", "1", false}, InterfaceState::up, true},
               Case{{"can0", "280", "0x40080", "", true}, InterfaceState::down, false},
               Case{{"can0", "280", "0x400c1", "0", true}, InterfaceState::bus_off, false},
               Case{{"eth0", "1", "0x1003", "1", true}, InterfaceState::not_can, false});
  const TemporaryFolder sys;
  make(sys, row.interface);
  const InterfaceLook look = look_at(row.interface.name, sys.file(""));
  CHECK(look.state == row.state);
  CHECK(look.is_virtual == row.is_virtual);
  CHECK(look_at("can9", sys.file("")).state == InterfaceState::absent);
}

TEST_CASE("CAN interfaces are listed, others are not") {
  const TemporaryFolder sys;
  make(sys, {"vcan1", "280", "0xc1", "1", false});
  make(sys, {"lo", "772", "0x9", "1", false});
  make(sys, {"can0", "280", "0x80", "", true});
  CHECK(can_interfaces(sys.file("")) == std::vector<std::string>{"can0", "vcan1"});
  CHECK(can_interfaces(sys.file("none")).empty());
}
