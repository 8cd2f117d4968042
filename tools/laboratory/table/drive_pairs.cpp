// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/table/drive_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cremed/can_decoders/ars408.hpp"
#include "cremed/can_decoders/ars408_tables.hpp"
#include "cremed/estimator/scan/stamps.hpp"
#include "tools/eval/drive/pose_windows.hpp"
#include "tools/eval/drive/recorded_states.hpp"
#include "tools/eval/drive/true_trajectory.hpp"
#include "tools/eval/input_file.hpp"
#include "tools/eval/recorded_drive.hpp"
#include "tools/laboratory/pairs/pairs_evaluation.hpp"
#include "tools/laboratory/pairs/profile.hpp"

namespace cremed {
namespace {

/// Longest time between the two scans of a pair.
constexpr double kMaxGapS = 0.5;

struct UsableScan {
  std::int64_t stamp_us = 0;
  std::vector<Detection> detections;
};

/// Collects the scans of the only radar.
class ScanSink final : public OdometrySink {
 public:
  void on_scan(std::size_t /*radar*/, const RadarScan& scan) override {
    if (scan.status != ScanStatus::complete) {
      return;
    }
    UsableScan& usable = scans.emplace_back();
    usable.stamp_us = scan.stamp_us;
    std::copy_if(scan.detections.begin(), scan.detections.begin() + scan.count,
                 std::back_inserter(usable.detections),
                 [](const Detection& d) { return d.validity == Validity::usable; });
  }

  std::vector<UsableScan> scans;
};

/// That radar alone, with default options: no correction, no limits, no odometry.
Configuration as_in_paper(const Configuration& configuration) {
  const RadarConfiguration& own = configuration.radars[paired_radar(configuration)];
  Configuration paper;
  paper.odometry.enabled = false;
  RadarConfiguration& radar = paper.radars.emplace_back();
  radar.name = own.name;
  radar.interface = own.interface;
  radar.decoder = own.decoder;
  radar.ego_motion.vehicle_from_radar = own.ego_motion.vehicle_from_radar;
  if (auto* ars408 = radar.decoder.as<Ars408Options>()) {
    *ars408 = {.sensor_id = ars408->sensor_id, .output = ars408->output, .model = ars408->model};
  }
  return paper;
}

/// The paper uses the rms codes of an ARS408, which are upper bounds, as standard deviations, and
/// adds the error of the line of sight to that of Doppler.
void take_codes_as_std(std::vector<UsableScan>& scans) {
  const double factor = ars408_rms(0).value() / ars408_std(0).value();
  for (UsableScan& scan : scans) {
    for (Detection& detection : scan.detections) {
      detection.range_std_m *= factor;
      detection.azimuth_std_rad *= factor;
      detection.doppler_std_mps = std::hypot(factor * detection.doppler_std_mps,
                                             detection.across_mps * detection.azimuth_std_rad);
    }
  }
}

std::vector<RegistrationPair> registration_pairs(const std::vector<UsableScan>& scans,
                                                 const Pose2& vehicle_from_radar,
                                                 const TrueTrajectory& truth) {
  std::vector<RegistrationPair> pairs;
  for (std::size_t i = 1; i < scans.size(); ++i) {
    const double dt_s = seconds_between(scans[i - 1].stamp_us, scans[i].stamp_us);
    const auto motion = truth.motion(scans[i - 1].stamp_us, scans[i].stamp_us);
    if (motion && dt_s <= kMaxGapS) {
      pairs.push_back({{motion->x(), motion->y(), motion->z()},
                       dt_s,
                       vehicle_from_radar,
                       scans[i - 1].detections,
                       scans[i].detections});
    }
  }
  return pairs;
}

PairedMotions solved(const std::vector<RegistrationPair>& pairs, const RegistrationOptions& options,
                     const TruthNoise& noise) {
  PairedMotions solved;
  for (const RegistrationPair& pair : pairs) {
    const RegistrationResult result = solve_pair(pair, options).registration;
    if (has_solution(result)) {
      solved.motions.push_back({result.motion,
                                result.covariance + noise.covariance(std::llround(1e6 * pair.dt_s)),
                                {pair.truth.x_m, pair.truth.y_m, pair.truth.yaw_rad}});
    } else {
      ++solved.left_out;
    }
  }
  return solved;
}

PairedMotions beside_truth(const RecordedRadar& radar, const TrueTrajectory& truth,
                           const TruthNoise& noise) {
  PairedMotions paired{{}, radar.without_estimate};
  for (const EgoMotion& motion : radar.motions) {
    if (const auto true_motion = truth.motion(motion.utime_start_us, motion.utime_us)) {
      const Eigen::Matrix3d of_truth = noise.covariance(motion.utime_us - motion.utime_start_us);
      paired.motions.push_back({motion.motion, motion.covariance + of_truth, *true_motion});
    }
  }
  return paired;
}

void add_paper(const DriveToPair& drive, std::string_view profile_name, const TrueTrajectory& truth,
               DrivePairs& result) {
  const Configuration configuration = as_in_paper(drive.configuration);
  ScanSink sink;
  play_drive(configuration, {drive.log}, &sink);
  if (configuration.radars[0].decoder.as<Ars408Options>() != nullptr) {
    take_codes_as_std(sink.scans);
  }
  const auto pairs =
      registration_pairs(sink.scans, configuration.radars[0].ego_motion.vehicle_from_radar, truth);
  constexpr Likelihood kPaper = Likelihood::max_sum_mixture;
  result.paper = solved(pairs, profile(profile_name, false, kPaper).value(), drive.truth_noise);
  result.paper_doppler =
      solved(pairs, profile(profile_name, true, kPaper).value(), drive.truth_noise);
}

}  // namespace

std::size_t paired_radar(const Configuration& configuration) {
  const auto& radars = configuration.radars;
  const auto front = std::ranges::find(radars, "front", &RadarConfiguration::name);
  return front == radars.end() ? 0 : static_cast<std::size_t>(front - radars.begin());
}

DrivePairs pair_drive(const DriveToPair& drive, std::string_view profile) {
  const auto truth = read_input<TrueTrajectory>(drive.truth);
  DrivePairs result;
  add_paper(drive, profile, truth, result);
  const PlayedDrive played = play_drive(drive.configuration, {drive.log});
  result.own =
      beside_truth(played.radars[paired_radar(drive.configuration)], truth, drive.truth_noise);
  const RecordedOdometry odometry = recorded_states(played.outputs).odometry;
  result.odometry =
      trajectory_segments(odometry, truth, drive.truth_noise, first_window_us({odometry}, truth));
  if (result.own.motions.empty()) {
    throw std::runtime_error(drive.log + ": no estimate within the time of " + drive.truth +
                             "; `cremed-doctor --replay` reports the reason");
  }
  return result;
}

}  // namespace cremed
