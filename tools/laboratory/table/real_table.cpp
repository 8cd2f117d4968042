// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/table/real_table.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>

#include "daemon/process/usage_error.hpp"
#include "tools/laboratory/made_in_parallel.hpp"
#include "tools/laboratory/table/drive_pairs.hpp"
#include "tools/laboratory/table/robot_drive.hpp"

namespace cremed {
namespace {

constexpr std::size_t kRobotDrives = 3;

struct RealMethod {
  std::string_view name;
  std::string_view published;
  PairedMotions DrivePairs::*motions;
};

constexpr std::array kMethods{RealMethod{"MSM(paper)", "MSM", &DrivePairs::paper},
                              RealMethod{"MSM-D(paper)", "MSM-D", &DrivePairs::paper_doppler},
                              RealMethod{"cremed", "MSM-D", &DrivePairs::own}};

RealRow row_of(std::string_view problem, const RealMethod& method,
               const std::vector<DrivePairs>& drives) {
  RealRow row{problem, method.name, published_figures(problem, method.published),
              published_figures(std::string(problem) + "-850", method.published)};
  for (const DrivePairs& drive : drives) {
    const PairedMotions& paired = drive.*method.motions;
    row.left_out += paired.left_out;
    for (const PairedMotion& motion : paired.motions) {
      row.credibility.add(motion.motion, motion.covariance, motion.truth);
    }
  }
  return row;
}

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// Means over the segments and chains of that length of all drives.
SegmentErrors joined(double time_s, const std::vector<DrivePairs>& drives) {
  SegmentErrors all{.length = {kNoLimit, time_s}};
  for (const DrivePairs& drive : drives) {
    const SegmentErrors& one = after_time(drive.odometry, time_s);
    if (one.segments > 0) {
      const auto weight = static_cast<double>(one.segments);
      all.segments += one.segments;
      all.rmse += weight * one.rmse.cwiseAbs2();
      all.position_percent += weight * one.position_percent;
    }
    if (one.chains > 0) {
      const auto weight = static_cast<double>(one.chains);
      all.chains += one.chains;
      all.anees += weight * one.anees;
      all.nees += weight * one.nees;
    }
  }
  const auto segments = static_cast<double>(all.segments);
  const auto chains = static_cast<double>(all.chains);
  all.rmse = (all.rmse / segments).cwiseSqrt();
  all.position_percent /= segments;
  all.anees /= chains;
  all.nees /= chains;
  return all;
}

void add(std::string_view problem, const std::vector<DrivePairs>& drives, RealTable& table) {
  for (const RealMethod& method : kMethods) {
    table.rows.push_back(row_of(problem, method, drives));
  }
  for (const double time_s : {1.0, 10.0}) {
    table.odometry.push_back({problem, joined(time_s, drives)});
  }
}

bool is_drive(const std::filesystem::path& folder) {
  return exists(folder / "can.log") && exists(folder / "truth.csv") &&
         exists(folder / "cremed.toml");
}

/// Sorted by name.
std::vector<std::filesystem::path> drives_in(const std::string& folder) {
  std::vector<std::filesystem::path> drives;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (is_drive(entry.path())) {
      drives.push_back(entry.path());
    }
  }
  if (drives.empty()) {
    throw UsageError("--real: " + folder +
                     " has no folder with can.log, truth.csv and cremed.toml; must be the "
                     "--output of `cremed-convert nuscenes`");
  }
  std::ranges::sort(drives);
  return drives;
}

DriveToPair drive_in(const std::filesystem::path& folder, const TruthNoise& noise) {
  return {folder / "can.log", folder / "truth.csv", load_configuration(folder / "cremed.toml"),
          noise};
}

}  // namespace

RealTable real_table(const RealTableOptions& options) {
  const std::vector<std::filesystem::path> folders = drives_in(options.folder);
  RealTable table;
  table.drives = folders.size();
  table.note = options.truth_noise.note();
  add("NuSc",
      made_in_parallel("NuSc", folders.size(), options.threads,
                       [&](std::size_t i) {
                         return pair_drive(drive_in(folders[i], options.truth_noise), "nuscenes");
                       }),
      table);
  add("Robot",
      made_in_parallel("Robot (simulated)", kRobotDrives, options.threads,
                       [&](std::size_t i) {
                         const TemporaryFolder folder;
                         return pair_drive(robot_drive(options.seed + i, folder), "robot");
                       }),
      table);
  return table;
}

}  // namespace cremed
