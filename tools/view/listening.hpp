// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace CLI {  // NOLINT(readability-identifier-naming): the library's.
class App;
}

namespace cremed {

/// Adds --lcm-url, where to listen; sets `url` to where LCM's own programs do if it is not given.
void add_lcm_url(CLI::App& app, std::string& url);

/// Throws CLI::ValidationError if nothing can be heard there. A log is read; with mode=w LCM would
/// empty it.
void require_audible(const std::string& url);

}  // namespace cremed
