// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace cremed {

/// Replaces a file atomically, following symbolic links; keeps its permissions (a new file gets the
/// default ones). Devices and pipes are written to. Throws std::runtime_error.
void replace_file(const std::string& path, std::string_view text);

/// Throws std::runtime_error, now, if a file could not be replaced later. Changes nothing.
void require_replaceable(const std::string& path);

/// The same for files only: a pipe would wait for its reader.
void replace_regular_file(const std::string& path, std::string_view text);

}  // namespace cremed
