// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "daemon/configuration/configuration.hpp"

namespace cremed {

/// The required keys of a radar: five lines, so that appended text starts at line 6.
inline std::string radar_text(const std::string& name, const std::string& type,
                              const std::string& interface) {
  std::string text = "[[radar]]\n";
  text.append("name = \"").append(name).append("\"\n");
  text.append("type = \"").append(type).append("\"\n");
  text.append("interface = \"").append(interface).append("\"\n");
  return text.append("mount = { x_m = 3.4, y_m = -0.5, yaw_rad = 0.25 }\n");
}

inline const std::string kArs408 = radar_text("front", "ars408", "can0");
inline const std::string kGpr = radar_text("left", "bosch_gpr", "can0");

inline std::string message_of(const std::string& text) {
  try {
    parse_configuration(text, "test.toml");
  } catch (const ConfigurationError& error) {
    return error.what();
  }
  return "accepted";
}

struct Refused {
  std::string text;
  int line;
  std::string key;
  std::string wrong;
  std::string right;
};

/// Exactly one error, with this line and key, that states the fault and the correction.
inline void check_refused(const std::vector<Refused>& rows) {
  for (const Refused& row : rows) {
    CAPTURE(row.text.substr(0, 300));
    const std::string message = message_of(row.text);
    const std::string head = "test.toml:" + std::to_string(row.line) + ": " + row.key + ": ";
    CHECK_THAT(message, Catch::StartsWith(head + row.wrong));
    CHECK_THAT(message, Catch::Contains(row.right));
    CHECK(std::ranges::count(message, '\n') == 0);
  }
}

}  // namespace cremed
