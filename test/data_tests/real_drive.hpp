// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/configuration/interfaces.hpp"
#include "daemon/radar_channel.hpp"
#include "daemon/source/candump.hpp"
#include "test/data_tests/shared_data.hpp"

namespace cremed::test {

inline Configuration configuration_of_car(const std::string& name) {
  return load_configuration(CREMED_SOURCE_DIR "/config/" + name + ".toml");
}

/// A recorded log in memory, with the configuration's interfaces.
inline std::vector<CanFrame> read_frames(const std::string& log,
                                         const Configuration& configuration) {
  const std::vector<std::string> names = interface_names(configuration);
  std::vector<CanFrame> frames;
  std::string_view rest = log;
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    CandumpLine line = parse_candump_line(rest.substr(0, end));
    if (line.status != CandumpStatus::frame) throw std::runtime_error("bad line in a log");
    line.frame.interface = static_cast<std::uint8_t>(
        std::find(names.begin(), names.end(), line.interface_name) - names.begin());
    frames.push_back(line.frame);
    rest.remove_prefix(end + 1);
  }
  return frames;
}

}  // namespace cremed::test
