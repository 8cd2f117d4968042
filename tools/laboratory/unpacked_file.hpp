// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/eval/temporary_folder.hpp"

namespace cremed {

/// The file itself, or that of the same name with ".xz", unpacked into the folder. Throws
/// std::runtime_error if there is neither or xz fails.
std::string unpacked_file(const std::string& path, const TemporaryFolder& folder);

}  // namespace cremed
