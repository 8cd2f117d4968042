// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "daemon/source/candump.hpp"

namespace cremed {

/// Reads the lines of a candump log; "-" is standard input. Throws std::runtime_error if it cannot
/// be read or has another format.
void read_log(const std::string& path, const std::function<void(const CandumpLine&)>& take);

}  // namespace cremed
