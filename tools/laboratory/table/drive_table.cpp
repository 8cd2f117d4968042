// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/table/drive_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>

#include "daemon/output/text_line.hpp"
#include "daemon/process/usage_error.hpp"
#include "tools/laboratory/made_in_parallel.hpp"
#include "tools/laboratory/table/drive_figures.hpp"

namespace cremed {
namespace {

std::string comment(std::string_view name) {
  return "<!-- cremed-eval table --drives: " + std::string(name) + " -->\n";
}

std::string line_of(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) {
    line += " " + cell + " |";
  }
  return line + "\n";
}

/// Comment and table.
struct Place {
  std::size_t begin = 0;
  std::size_t end = 0;
};

std::optional<Place> find(const std::string& readme, std::string_view name) {
  const std::string title = comment(name);
  const std::size_t begin = readme.find(title);
  if (begin == std::string::npos) {
    return std::nullopt;
  }
  Place place{begin, begin + title.size()};
  while (place.end < readme.size() && readme[place.end] == '|') {
    place.end = readme.find('\n', place.end);
    place.end = place.end == std::string::npos ? readme.size() : place.end + 1;
  }
  return place;
}

struct KnownDrive {
  std::string_view name;
  std::string_view folder;         ///< In that of the data.
  std::string_view configuration;  ///< In the drive's folder, or in the project's config.
  bool is_in_mean = false;
};

constexpr std::array kDrives{
    KnownDrive{"nuScenes 0061", "nuscenes/scene-0061", "nuscenes-singapore.toml", true},
    KnownDrive{"nuScenes 0103", "nuscenes/scene-0103", "nuscenes-boston.toml", true},
    KnownDrive{"nuScenes 0655", "nuscenes/scene-0655", "nuscenes-boston.toml", true},
    KnownDrive{"nuScenes 0796", "nuscenes/scene-0796", "nuscenes-singapore.toml", true},
    KnownDrive{"nuScenes 1094", "nuscenes/scene-1094", "nuscenes-singapore.toml", true},
    KnownDrive{"RadarScenes 105", "radarscenes/sequence-105", "radarscenes.toml"},
    KnownDrive{"... motion flags ignored", "radarscenes/sequence-105",
               "radarscenes-unflagged.toml"}};

constexpr std::string_view kMeanName = "nuScenes, mean";

/// Figures of one group. In the pattern each digit is a figure with that many decimals.
struct Column {
  std::string_view title;
  std::string_view group;
  std::string_view pattern;
};

struct Layout {
  std::string_view name;
  std::vector<Column> columns;
};

/// Yaw in degrees, per cent of the path, ANEES.
constexpr std::string_view kPose = "2 / 2 / 2";

const std::vector<Layout>& layouts() {
  static const std::vector<Layout> kLayouts{
      {"times",
       {{"after 1 s", "1 s", kPose},
        {"5 s", "5 s", kPose},
        {"10 s", "10 s", kPose},
        {"30 s", "30 s", kPose},
        {"10 s, front radar alone", "front alone", kPose}}},
      {"methods",
       {{"cremed", "10 s", kPose},
        {"submap of ten sweeps", "submap", kPose},
        {"submap of 80 sweeps", "submap_80", kPose},
        {"Kellner's velocity", "kellner", "2 / 2 / 0"}}},
      {"scans",
       {{"front: m / deg / ANEES", "front", "4 / 3 / 2"},
        {"both rear radars", "rear", "4 / 3 / 2"},
        {"front: NEES of x by the wheels, of yaw by the gyro", "front by wheels", "2, 2"},
        {"odometry from output to output: the same", "outputs by wheels", "2, 2"}}}};
  return kLayouts;
}

/// "–" if the drive has no such figures.
std::string cell(const DriveFigures& figures, const Column& column) {
  const auto found = figures.find(column.group);
  const auto is_number = [](double value) { return std::isfinite(value); };
  if (found == figures.end() || !std::ranges::all_of(found->second, is_number)) {
    return "–";
  }
  std::string text;
  std::size_t next = 0;
  for (const char letter : column.pattern) {
    if (letter >= '0' && letter <= '9') {
      text += TextLine().fixed(found->second.at(next++), letter - '0').view();
    } else {
      text += letter;
    }
  }
  return text;
}

/// The file, of a drive that is there.
std::filesystem::path configuration_of(const KnownDrive& known, const DriveTableOptions& options) {
  const auto folder = std::filesystem::path(options.data) / known.folder;
  auto configuration = folder / known.configuration;
  if (!exists(configuration)) {
    configuration = std::filesystem::path(options.project) / "config" / known.configuration;
  }
  for (const auto& path : {folder / "truth.csv", configuration}) {
    if (!exists(path)) {
      throw UsageError("--drives: there is no " + path.string() +
                       "; FOLDER must hold the recorded drives, and the command be run in the "
                       "project's folder");
    }
  }
  return configuration;
}

struct NamedFigures {
  std::string name;
  DriveFigures figures;
};

/// With the mean below those in it.
std::vector<NamedFigures> all_figures(const DriveTableOptions& options) {
  std::vector<std::filesystem::path> configurations;
  for (const KnownDrive& known : kDrives) {
    configurations.push_back(configuration_of(known, options));
  }
  const auto figures =
      made_in_parallel("drives", kDrives.size(), options.threads, [&](std::size_t i) {
        return drive_figures(std::filesystem::path(options.data) / kDrives[i].folder,
                             configurations[i]);
      });
  std::vector<NamedFigures> result;
  std::vector<DriveFigures> in_mean;
  for (std::size_t i = 0; i < kDrives.size(); ++i) {
    if (!kDrives[i].is_in_mean && !in_mean.empty()) {
      result.push_back({std::string(kMeanName), mean_figures(in_mean)});
      in_mean.clear();
    }
    result.push_back({std::string(kDrives[i].name), figures[i]});
    if (kDrives[i].is_in_mean) {
      in_mean.push_back(figures[i]);
    }
  }
  return result;
}

/// Rows only of drives with at least one of the figures.
ReadmeTable table_of(const Layout& layout, const std::vector<NamedFigures>& drives) {
  ReadmeTable table{std::string(layout.name), {"drive"}, {}};
  for (const Column& column : layout.columns) {
    table.header.emplace_back(column.title);
  }
  for (const NamedFigures& drive : drives) {
    const bool has_any = std::ranges::any_of(
        layout.columns, [&](const Column& column) { return drive.figures.contains(column.group); });
    if (has_any) {
      std::vector<std::string>& row = table.rows.emplace_back();
      row.push_back(drive.name);
      for (const Column& column : layout.columns) {
        row.push_back(cell(drive.figures, column));
      }
    }
  }
  return table;
}

}  // namespace

std::string to_markdown(const ReadmeTable& table) {
  std::string text = comment(table.name) + line_of(table.header) + "|";
  for (std::size_t i = 0; i < table.header.size(); ++i) {
    text += "---|";
  }
  text += "\n";
  for (const auto& row : table.rows) {
    text += line_of(row);
  }
  return text;
}

std::string with_table(const std::string& readme, const ReadmeTable& table) {
  const auto place = find(readme, table.name);
  return place ? readme.substr(0, place->begin) + to_markdown(table) + readme.substr(place->end)
               : readme;
}

std::vector<ReadmeTable> drive_tables(const DriveTableOptions& options) {
  const auto drives = all_figures(options);
  std::vector<ReadmeTable> tables;
  for (const Layout& layout : layouts()) {
    tables.push_back(table_of(layout, drives));
  }
  return tables;
}

}  // namespace cremed
