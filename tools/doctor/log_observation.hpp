// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "daemon/configuration/configuration.hpp"
#include "daemon/source/candump.hpp"
#include "tools/doctor/observation.hpp"

namespace cremed {

/// Reads the lines of a candump log; "-" is standard input. Throws std::runtime_error if it cannot
/// be read or has another format.
void read_log(const std::string& path, const std::function<void(const CandumpLine&)>& take);

/// Observes all buses of a candump log; "-" is standard input. Throws std::runtime_error if it
/// cannot be read or holds no frame.
Observation observe_log(const Configuration& configuration, const std::string& path);

/// The message for a log without a frame.
std::string no_frame_in(const std::string& path);

}  // namespace cremed
