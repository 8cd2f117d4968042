// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/table/drive_figures.hpp"

#include <algorithm>
#include <filesystem>

#include "cremed/estimator/scan/degrees.hpp"
#include "tools/eval/credibility.hpp"
#include "tools/eval/drive/against_wheels.hpp"
#include "tools/eval/drive/baselines.hpp"
#include "tools/eval/drive/pose_windows.hpp"
#include "tools/eval/drive/recorded_states.hpp"
#include "tools/eval/drive/trajectory_segments.hpp"
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

/// Keeps what the odometry puts out.
class OutputSink final : public OdometrySink {
 public:
  void on_odometry(const Odometry& odometry) override { outputs.push_back(odometry); }
  void on_fused(const EgoMotion& motion, std::int32_t) override {
    if (motion.has_estimate()) {
      fused.push_back(motion);
    }
  }

  std::vector<Odometry> outputs;
  std::vector<EgoMotion> fused;
};

std::vector<RecordedEstimate> recorded(const std::vector<EgoMotion>& motions) {
  std::vector<RecordedEstimate> result;
  result.reserve(motions.size());
  for (const EgoMotion& motion : motions) {
    result.push_back({motion.utime_start_us, motion.utime_us, motion.motion, motion.covariance});
  }
  return result;
}

std::vector<double> pose_figures(const SegmentErrors& errors) {
  return {kDegPerRad * errors.rmse.z(), errors.position_percent, errors.anees};
}

std::vector<SegmentErrors> segments_of(const RecordedOdometry& odometry,
                                       const TrueTrajectory& truth) {
  return trajectory_segments(odometry, truth, {}, first_window_us({odometry}, truth));
}

void add_odometry(const RecordedOdometry& odometry, const TrueTrajectory& truth,
                  DriveFigures& figures) {
  const auto segments = segments_of(odometry, truth);
  for (const double time_s : {1.0, 5.0, 10.0, 30.0}) {
    const SegmentErrors& errors = after_time(segments, time_s);
    figures[to_text(errors.length)] = pose_figures(errors);
  }
}

void add_front_alone(Configuration configuration, const std::string& log,
                     const TrueTrajectory& truth, DriveFigures& figures) {
  std::erase_if(configuration.radars, [](const auto& radar) { return radar.name != "front"; });
  if (configuration.radars.empty()) {
    return;
  }
  OutputSink sink;
  play_drive(configuration, {log}, {&sink});
  const RecordedOdometry odometry = recorded_states(sink.outputs).odometry;
  figures["front alone"] = pose_figures(after_time(segments_of(odometry, truth), 10.0));
}

/// On the windows of `odometry`.
void add_baselines(const Configuration& configuration, const std::vector<RecordedRadar>& radars,
                   const RecordedOdometry& odometry, const TrueTrajectory& truth,
                   DriveFigures& figures) {
  const std::int64_t first_us = first_window_us({odometry}, truth);
  for (const RecordedOdometry& method : baselines(configuration, radars)) {
    const auto segments = trajectory_segments(method, truth, {}, first_us);
    figures[method.source] = pose_figures(after_time(segments, 10.0));
  }
}

std::vector<double> nees(const std::vector<RecordedEstimate>& estimates,
                         const TrueTrajectory& truth, const WheelReference& wheels) {
  const MotionsAgainstWheels result = against_wheels(estimates, truth, wheels);
  return {result.x.nees, result.yaw.nees};
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

void add_scans(const RecordedOdometry& scans, const TrueTrajectory& truth, DriveFigures& figures) {
  const TruthNoise noise = nuscenes_truth_noise();
  Credibility credibility(degrees_of_freedom(scans));
  for (const RecordedEstimate& estimate : scans.estimates) {
    if (const auto motion = truth.motion(estimate.start_us, estimate.end_us)) {
      const auto of_truth = noise.covariance(estimate.end_us - estimate.start_us);
      credibility.add(estimate.motion, estimate.covariance + of_truth, *motion);
    }
  }
  figures[scans.source] = {credibility.rmse_m(), credibility.rmse_deg(), credibility.anees()};
}

}  // namespace

DriveFigures drive_figures(const TabledDrive& drive) {
  const TemporaryFolder unpacked;
  const std::filesystem::path folder = drive.folder;
  const std::string log = unpacked_file(folder / "can.log", unpacked);
  const auto truth = read_input<TrueTrajectory>(folder / "truth.csv");
  const Configuration configuration = load_configuration(drive.configuration);
  OutputSink sink;
  const auto radars = record_drive(configuration, {log}, {&sink});
  const RecordedOdometry odometry = recorded_states(sink.outputs).odometry;
  DriveFigures figures;
  add_odometry(odometry, truth, figures);
  add_front_alone(configuration, log, truth, figures);
  add_baselines(configuration, radars, odometry, truth, figures);
  if (exists(folder / "wheels.csv")) {
    const auto wheels = read_input<WheelReference>(folder / "wheels.csv");
    const RecordedOdometry front = scans_of("front", configuration, radars);
    add_scans(front, truth, figures);
    add_scans(scans_of("rear", configuration, radars), truth, figures);
    figures["front by wheels"] = nees(front.estimates, truth, wheels);
    figures["outputs by wheels"] = nees(recorded(sink.fused), truth, wheels);
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
