// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cremed/can_decoders/ars408_messages.hpp"
#include "tools/doctor/ars408_talk.hpp"

namespace cremed {

/// Syntax of a filter: "rcs=-5..60" or "rcs=off".
inline constexpr const char* kArs408FilterWanted =
    "NAME=MIN..MAX or NAME=off, with NAME one of count, range (m), azimuth (deg), oncoming, "
    "departing (m/s, along the line of sight), rcs (dBm^2)";

/// Parses a filter for clusters; nothing if it is invalid or cannot be sent exactly.
std::optional<Ars408FilterState> parse_ars408_filter(std::string_view text);

/// "rcs: -5 to 60 dBm^2"; "rcs: off"
std::string to_text(const Ars408FilterState& filter);

/// Shows which clusters the sensor's filters pass, which it sends on request only, and sets
/// `wanted` filters if there are any. Shows the frames, asks for consent, and sends one frame at a
/// time, each after the answer to the last.
TalkResult talk_about_filters(const Ars408Talk& talk, const std::vector<Ars408FilterState>& wanted);

}  // namespace cremed
