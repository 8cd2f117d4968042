// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Arbitrary bytes as a configuration file: either a valid configuration or a ConfigurationError
// with file and line; no other exception, no crash.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "daemon/configuration/configuration.hpp"

namespace {

using namespace cremed;

void check(bool holds) {
  if (!holds) {
    std::abort();
  }
}

void check_accepted(const Configuration& configuration) {
  check(!configuration.radars.empty() && configuration.radars.size() <= kMaxRadars);
  for (const RadarConfiguration& radar : configuration.radars) {
    check(!radar.name.empty() && radar.name.size() <= 15);
    check(!radar.interface.empty() && radar.interface.size() <= 15);
    check(radar.scan_timeout_s > 0.0);
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): the name libFuzzer calls.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    check_accepted(parse_configuration({reinterpret_cast<const char*>(data), size}, "file"));
  } catch (const ConfigurationError& error) {
    check(std::string_view(error.what()).starts_with("file:"));
  }
  return 0;
}
