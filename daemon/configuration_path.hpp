// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace cremed {

/// The file that --config names; without one /etc/cremed/cremed.toml, and where there is none, the
/// installed one.
std::string configuration_path(const std::string& named);

}  // namespace cremed
