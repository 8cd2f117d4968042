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

/// How a filter is to be given: "rcs=-5..60" or "rcs=off".
inline constexpr const char* kArs408FilterWanted =
    "NAME=MIN..MAX or NAME=off, with NAME one of count, range (m), azimuth (deg), oncoming, "
    "departing (m/s, along the line of sight), rcs (dBm^2)";

/// A filter of clusters as the user words it; nothing if it is none, or cannot be sent as it is.
std::optional<Ars408FilterState> parse_ars408_filter(std::string_view text);

/// "rcs: -5 to 60 dBm^2"; "rcs: off"
std::string to_text(const Ars408FilterState& filter);

/// Shows what clusters the sensor's own filters let pass, which it tells only when asked, and sets
/// some of them, if there are any. Shows the frames, asks, sends one after the other, each once the
/// sensor has answered the one before.
TalkResult talk_about_filters(const Ars408Talk& talk, const std::vector<Ars408FilterState>& wanted);

}  // namespace cremed
