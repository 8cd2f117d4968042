// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace cremed {

/// Replaces a file, which a symbolic link may lead to, at once: nobody ever reads a part of it. It
/// keeps its permissions; a new one has the usual ones. Devices and pipes are written to. Throws
/// std::runtime_error.
void replace_file(const std::string& path, std::string_view text);

}  // namespace cremed
