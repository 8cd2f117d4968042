// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace cremed {

/// A file and what it is to the user: "--replay", "the configuration". An empty path is no file,
/// "-" a standard stream.
struct NamedFile {
  std::string name;
  std::string path;
};

/// Opening an output empties it: none may be an input or another output, by whatever path, also
/// where neither exists yet; nor a file that a standard stream is redirected from or to. Opens
/// nothing; throws UsageError. Devices such as /dev/null are anybody's.
void refuse_aliases(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs);

/// The path of an LCM URL that is a file, file://PATH?mode=w; empty for others.
std::string lcm_file(std::string_view url);

}  // namespace cremed
