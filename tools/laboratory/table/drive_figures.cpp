// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/table/drive_figures.hpp"

#include <algorithm>
#include <filesystem>

#include "cremed/estimator/scan/degrees.hpp"
#include "tools/eval/drive/baselines.hpp"
#include "tools/eval/drive/drive_evaluation.hpp"
#include "tools/eval/drive/pose_windows.hpp"
#include "tools/eval/drive/recorded_states.hpp"
#include "tools/eval/input_file.hpp"
#include "tools/eval/recorded_drive.hpp"
#include "tools/eval/temporary_folder.hpp"
#include "tools/laboratory/unpacked_file.hpp"

namespace cremed {
namespace {

/// Relative poses of nuScenes' truth against wheels and gyro on scenes 0061 and 0103 (`cremed-eval
/// drive --wheels`); up to 60 % larger on others.
TruthNoise nuscenes_truth_noise() {
  return TruthNoise({{0.0075, 0.0017, 0.00045, 0.075},
                     {0.013, 0.003, 0.00065, 0.15},
                     {0.021, 0.0055, 0.00083, 0.3}});
}

std::vector<RecordedEstimate> recorded(const std::vector<EgoMotion>& motions) {
  std::vector<RecordedEstimate> result;
  result.reserve(motions.size());
  for (const EgoMotion& motion : motions) {
    result.push_back({motion.utime_start_us, motion.utime_us, motion.motion, motion.covariance});
  }
  return result;
}

SourceEvaluation evaluated(const RecordedOdometry& odometry, const DriveReference& reference) {
  return evaluate_source(odometry, reference, first_window_us({odometry}, reference.truth));
}

std::vector<double> pose_figures(const SegmentErrors& errors) {
  return {kDegPerRad * errors.rmse.z(), errors.position_percent, errors.anees};
}

std::vector<double> after_10_s(const SourceEvaluation& source) {
  return pose_figures(after_time(source.segments, 10.0));
}

void add_front_alone(Configuration configuration, const std::string& log,
                     const DriveReference& reference, DriveFigures& figures) {
  std::erase_if(configuration.radars, [](const auto& radar) { return radar.name != "front"; });
  if (!configuration.radars.empty()) {
    const PlayedDrive alone = play_drive(configuration, {log});
    figures["front alone"] =
        after_10_s(evaluated(recorded_states(alone.outputs).odometry, reference));
  }
}

std::vector<double> nees_by_wheels(const SourceEvaluation& source) {
  return {source.wheels->x.nees, source.wheels->yaw.nees};
}

/// All estimates of the radars whose name begins so.
RecordedOdometry scans_of(const std::string& place, const Configuration& configuration,
                          const std::vector<RecordedRadar>& radars) {
  RecordedOdometry result{place, {}, 0};
  for (std::size_t i = 0; i < radars.size(); ++i) {
    if (configuration.radars[i].name.starts_with(place)) {
      const auto estimates = recorded(radars[i].motions);
      result.estimates.insert(result.estimates.end(), estimates.begin(), estimates.end());
    }
  }
  return result;
}

/// `reference`: with wheels.
void add_by_wheels(const Configuration& configuration, const PlayedDrive& played,
                   const DriveReference& reference, DriveFigures& figures) {
  for (const char* place : {"front", "rear"}) {
    const SourceEvaluation scans =
        evaluated(scans_of(place, configuration, played.radars), reference);
    const Credibility& credibility = scans.credibility;
    figures[scans.source] = {credibility.rmse_m(), credibility.rmse_deg(), credibility.anees()};
    if (scans.source == "front") {
      figures["front by wheels"] = nees_by_wheels(scans);
    }
  }
  figures["outputs by wheels"] =
      nees_by_wheels(evaluated({"fused", recorded(played.fused), 0}, reference));
}

}  // namespace

DriveFigures drive_figures(const std::filesystem::path& folder,
                           const std::string& configuration_file) {
  const TemporaryFolder unpacked;
  const std::string log = unpacked_file(folder / "can.log", unpacked);
  DriveReference reference{read_input<TrueTrajectory>(folder / "truth.csv"), {}, {}};
  const Configuration configuration = load_configuration(configuration_file);
  const PlayedDrive played = record_drive(configuration, {log});
  const SourceEvaluation odometry = evaluated(recorded_states(played.outputs).odometry, reference);
  DriveFigures figures;
  for (const double time_s : {1.0, 5.0, 10.0, 30.0}) {
    const SegmentErrors& errors = after_time(odometry.segments, time_s);
    figures[to_text(errors.length)] = pose_figures(errors);
  }
  add_front_alone(configuration, log, reference, figures);
  for (const RecordedOdometry& method : baselines(configuration, played.radars)) {
    figures[method.source] =
        after_10_s(evaluate_source(method, reference, odometry.first_window_us));
  }
  if (exists(folder / "wheels.csv")) {
    reference.truth_noise = nuscenes_truth_noise();
    reference.wheels = read_input<WheelReference>(folder / "wheels.csv");
    add_by_wheels(configuration, played, reference, figures);
  }
  return figures;
}

DriveFigures mean_figures(const std::vector<DriveFigures>& drives) {
  DriveFigures mean = drives.empty() ? DriveFigures{} : drives.front();
  std::erase_if(mean, [&](const auto& group) {
    return !std::ranges::all_of(drives,
                                [&](const DriveFigures& one) { return one.contains(group.first); });
  });
  for (auto& [name, values] : mean) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = 0.0;
      for (const DriveFigures& one : drives) {
        values[i] += one.at(name)[i] / static_cast<double>(drives.size());
      }
    }
  }
  return mean;
}

}  // namespace cremed
