// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cremed {

/// A table of a README, in Markdown below a comment with its name.
struct ReadmeTable {
  std::string name;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// Comment and table.
std::string to_markdown(const ReadmeTable& table);

/// The rows of the table with that name in a README, without its header; nothing if it has none.
std::optional<std::vector<std::vector<std::string>>> rows_in(const std::string& readme,
                                                             std::string_view name);

/// The README with the table in place of that of the same name; unchanged if it has none.
std::string with_table(const std::string& readme, const ReadmeTable& table);

}  // namespace cremed
