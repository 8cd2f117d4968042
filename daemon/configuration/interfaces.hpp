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

/// Interface of a radar that RadarSearch has to find.
inline constexpr std::string_view kAutoInterface = "auto";

bool is_auto(const RadarConfiguration& radar);

/// Whether every interface is given by name.
bool has_interface_names(const Configuration& configuration);

struct Interfaces {
  /// Distinct names of the radars' interfaces, in order of first use, and then [vehicle]'s if it is
  /// another. Each "auto" has an entry of its own.
  std::vector<std::string> names;
  std::vector<std::uint8_t> of_radars;  ///< CanFrame::interface, by radar: index in `names`.
  std::uint8_t of_vehicle = 0;          ///< The same of [vehicle]'s, if it has one.
};

Interfaces interfaces_of(const Configuration& configuration);

/// Their names.
std::vector<std::string> interface_names(const Configuration& configuration);

/// Throws ConfigurationError if a radar has interface "auto", which a log cannot resolve.
void require_interface_names(const Configuration& configuration);

}  // namespace cremed
