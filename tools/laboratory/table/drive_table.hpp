// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
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

/// The README with the table in place of that of the same name; unchanged if it has none.
std::string with_table(const std::string& readme, const ReadmeTable& table);

struct DriveTableOptions {
  std::string data;           ///< Folder of the recorded drives.
  std::string project = ".";  ///< Folder of the project: its config/ and tools/eval/README.md.
  unsigned threads = 1;
};

/// Where these tables stand, in the project.
inline constexpr const char* kReadmeWithTables = "tools/eval/README.md";

/// Its tables of the recorded drives: five scenes of nuScenes and a sequence of
/// RadarScenes. Throws UsageError if a drive or a configuration is missing, std::runtime_error if
/// one cannot be read.
std::vector<ReadmeTable> drive_tables(const DriveTableOptions& options);

}  // namespace cremed
