// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/recorded_drive.hpp"

#include <algorithm>
#include <csignal>
#include <stdexcept>
#include <utility>

#include "cremed/estimator/scan/rotation_lead.hpp"
#include "daemon/configuration/interfaces.hpp"
#include "daemon/pipeline.hpp"
#include "daemon/process/message_text.hpp"
#include "daemon/source/replay.hpp"

namespace cremed {
namespace {

class RecordingSink final : public OdometrySink {
 public:
  explicit RecordingSink(const Configuration& configuration)
      : configuration_(configuration),
        drive_{std::vector<RecordedRadar>(configuration.radars.size()), {}, {}} {}

  void on_scan(std::size_t radar, const RadarScan& scan) override {
    const EgoMotionOptions& options = configuration_.radars[radar].ego_motion;
    if (scan.status != ScanStatus::complete) {
      return;
    }
    targets_.assign(scan, {}, options.limits, counters_, options.correction);
    if (targets_.is_finite()) {
      drive_.radars[radar].scans.push_back(
          {scan.stamp_us, {targets_.begin(), targets_.end()}, told_yaw_rate_radps(radar, scan)});
    }
  }

  void on_motion(std::size_t radar, const EgoMotion& motion, std::int32_t) override {
    if (motion.has_estimate()) {
      drive_.radars[radar].motions.push_back(motion);
    } else if (motion.status != MotionStatus::no_reference) {
      ++drive_.radars[radar].without_estimate;
    }
  }

  void on_odometry(const Odometry& odometry) override { drive_.outputs.push_back(odometry); }

  void on_fused(const EgoMotion& motion, std::int32_t) override {
    if (motion.has_estimate()) {
      drive_.fused.push_back(motion);
    }
  }

  /// Clusters only: an object's velocity across is measured.
  [[nodiscard]] double told_yaw_rate_radps(std::size_t radar, const RadarScan& scan) const {
    const auto* ars408 = configuration_.radars[radar].decoder.as<Ars408Options>();
    return ars408 != nullptr && ars408->output == Ars408Output::clusters
               ? reported_yaw_rate_radps(scan)
               : 0.0;
  }

  PlayedDrive take() { return std::move(drive_); }

 private:
  const Configuration& configuration_;
  PlayedDrive drive_;
  TargetSet targets_;
  SelectionCounters counters_;
};

void check_logs(const Replay& replay) {
  for (const auto& log : replay.logs()) {
    if (const std::string problem = log.problem(); !problem.empty()) {
      throw std::runtime_error(problem);
    }
  }
}

}  // namespace

PlayedDrive play_drive(const Configuration& configuration, const std::vector<std::string>& logs,
                       OdometrySink* other) {
  require_interface_names(configuration);
  const volatile std::sig_atomic_t stop = 0;
  Replay replay(logs, interface_names(configuration), 0.0, &stop);
  RecordingSink recording(configuration);
  std::vector<OdometrySink*> sinks{&recording};
  if (other != nullptr) {
    sinks.push_back(other);
  }
  Pipeline pipeline(configuration, replay, sinks, {});
  while (pipeline.take_next(replay)) {
  }
  pipeline.finish();
  check_logs(replay);
  return recording.take();
}

PlayedDrive record_drive(const Configuration& configuration, const std::vector<std::string>& logs) {
  PlayedDrive drive = play_drive(configuration, logs);
  if (std::ranges::all_of(drive.radars, [](const auto& r) { return r.scans.empty(); })) {
    throw std::runtime_error(
        concat({logs.front(), ": no complete scan of any radar; `cremed-doctor --replay ",
                in_shell(logs.front()), "` tells why"}));
  }
  return drive;
}

}  // namespace cremed
