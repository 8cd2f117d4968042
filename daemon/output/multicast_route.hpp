// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace cremed {

/// Why messages cannot leave for the multicast group of a udpm:// URL, with the command that mends
/// it; empty if they can, or if the URL is of another kind. Asked for before lcm_create, which
/// prints a riddle and leaks a descriptor where no route leads to the group.
std::string multicast_problem(const std::string& url);

}  // namespace cremed
