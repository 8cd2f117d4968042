// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/table/table_command.hpp"

#include <cstdio>
#include <filesystem>

#include "daemon/process/replaced_file.hpp"
#include "tools/eval/input_file.hpp"
#include "tools/eval/plot.hpp"
#include "tools/eval/temporary_folder.hpp"
#include "tools/laboratory/figures_json.hpp"
#include "tools/laboratory/table/cost_curves.hpp"
#include "tools/laboratory/table/table_report.hpp"

namespace cremed {

void run_table(const PaperTableOptions& options, const std::string& picture, bool as_json) {
  const std::vector<TableRow> rows = paper_table(options);
  if (as_json) {
    std::printf("%s\n", table_json(rows).c_str());
  } else {
    print_table(stdout, rows);
  }
  if (picture.empty()) {
    return;
  }
  const TemporaryFolder folder;
  const std::string table = folder.file("table.csv");
  const std::string nees = folder.file("nees.csv");
  const std::string costs = folder.file("costs.csv");
  write_table_csv(table, rows);
  write_nees_csv(nees, rows);
  write_cost_csv(costs);
  draw_plot("plot_table", {table, nees, costs}, picture);
}

void run_real_table(const RealTableOptions& options, bool as_json) {
  const RealTable table = real_table(options);
  if (as_json) {
    std::printf("%s\n", real_table_json(table).c_str());
  } else {
    print_real_table(stdout, table);
  }
}

void run_drive_table(const DriveTableOptions& options, bool write) {
  const std::vector<ReadmeTable> tables = drive_tables(options);
  if (!write) {
    for (const ReadmeTable& table : tables) {
      std::printf("%s\n", to_markdown(table).c_str());
    }
    return;
  }
  const std::string path = std::filesystem::path(options.project) / kReadmeWithTables;
  std::string text = with_input(path, content);
  for (const ReadmeTable& table : tables) {
    text = with_table(text, table);
  }
  replace_file(path, text);
}

}  // namespace cremed
