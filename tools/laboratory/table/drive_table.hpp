// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/laboratory/table/readme_table.hpp"

namespace cremed {

struct DriveTableOptions {
  std::string data;           ///< Folder of the recorded drives.
  std::string project = ".";  ///< Folder of the project: its config/ and READMEs.
  unsigned threads = 1;
};

/// The READMEs with such tables, in the project.
inline const std::vector<std::string> kReadmesWithTables{"README.md", "tools/eval/README.md"};

/// The READMEs' tables of the recorded drives: five scenes of nuScenes and a sequence of
/// RadarScenes. Throws UsageError if a drive or a configuration is missing, std::runtime_error if
/// one cannot be read.
std::vector<ReadmeTable> drive_tables(const DriveTableOptions& options);

}  // namespace cremed
