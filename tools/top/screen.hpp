// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace cremed {

/// What a line says of the odometry or a radar.
enum class Mood : std::uint8_t { plain, good, careful, bad };

struct ScreenLine {
  std::string text;  ///< Printable ASCII.
  Mood mood = Mood::plain;
};

/// What cremed-top shows of HeardState::snapshot(), for a terminal of any width. `source`: where it
/// was heard.
std::vector<ScreenLine> screen_of(const nlohmann::json& state, const std::string& source);

}  // namespace cremed
