// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace cremed {

/// Why the multicast group of a udpm:// URL is unreachable, with a remedy; empty if it is reachable
/// or the URL is of another kind. Checked before lcm_create, which without a route prints an
/// obscure message and leaks a descriptor.
std::string multicast_problem(const std::string& url);

/// Why lcm_create failed after that, by its errno.
std::string lcm_create_problem(int error);

}  // namespace cremed
