// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/configuration/configuration.hpp"

namespace cremed {

/// For a radar whose interface is to be found (RadarSearch).
inline constexpr std::string_view kAutoInterface = "auto";

bool is_auto(const RadarConfiguration& radar);

/// Whether no interface is to be found.
bool has_interface_names(const Configuration& configuration);

/// Distinct names of the radars' interfaces, in order of first mention. Each radar whose interface
/// is to be found has an entry of its own.
std::vector<std::string> interface_names(const Configuration& configuration);

/// CanFrame::interface of a radar of the configuration: where its interface is in that list.
std::uint8_t interface_index(const Configuration& configuration, std::size_t radar);

/// Throws ConfigurationError if the interface of a radar is to be found: in a log it cannot be.
void require_interface_names(const Configuration& configuration);

}  // namespace cremed
