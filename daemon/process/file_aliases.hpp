// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace cremed {

/// A file and its role: "--replay", "the configuration". An empty path is no file, "-" a standard
/// stream.
struct NamedFile {
  std::string name;
  std::string path;
};

/// Opening an output truncates it. Throws UsageError if an output is also an input, another output
/// or the file of a redirected standard stream, or an input another input of the same name, by any
/// path, existing or not. Opens nothing; devices such as /dev/null are exempt.
void refuse_aliases(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs);

/// What a link leads to, existing or not; other paths stay.
std::filesystem::path end_of_links(std::filesystem::path path);

/// The path in an LCM URL file://PATH?mode=w; empty for others.
std::string lcm_file(std::string_view url);

}  // namespace cremed
