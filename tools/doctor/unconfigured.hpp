// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "daemon/configuration/configuration.hpp"
#include "tools/doctor/interface_search.hpp"
#include "tools/doctor/observation.hpp"
#include "tools/doctor/suggestion.hpp"

// For one who has a log, or buses, and no configuration yet.
namespace cremed {

/// To observe buses without knowing what is on them.
Configuration without_radars();

/// Whether no one has said yet which radars there are: neither `named` nor the standard file does.
bool is_unconfigured(const std::string& named);

/// A log that cannot be read twice.
bool is_pipe(const std::string& log);

/// The radars observed, to examine each alone (examined_configuration), with findings that tell
/// which are left out. Throws std::runtime_error with the traffic and advice if there are none.
LocatedRadars examined_radars(const Observation& observation,
                              ExaminedOutput output = ExaminedOutput::clusters);

/// The same, also with findings that tell what they are, which buses are silent and how to write a
/// configuration.
LocatedRadars found_radars(const Observation& observation);

}  // namespace cremed
