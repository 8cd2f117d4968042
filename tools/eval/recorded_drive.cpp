// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/recorded_drive.hpp"

#include <algorithm>
#include <csignal>
#include <memory>
#include <stdexcept>
#include <utility>

#include "cremed/estimator/scan/rotation_lead.hpp"
#include "daemon/configuration/interfaces.hpp"
#include "daemon/pipeline.hpp"
#include "daemon/process/message_text.hpp"
#include "daemon/source/candump_log.hpp"
#include "daemon/source/replay.hpp"

namespace cremed {
namespace {

class RecordingSink final : public OdometrySink {
 public:
  explicit RecordingSink(const Configuration& configuration)
      : configuration_(configuration), radars_(configuration.radars.size()) {}

  void on_scan(std::size_t radar, const RadarScan& scan) override {
    const EgoMotionOptions& options = configuration_.radars[radar].ego_motion;
    if (scan.status != ScanStatus::complete) {
      return;
    }
    targets_.assign(scan, {}, options.limits, counters_, options.correction);
    if (targets_.is_finite()) {
      radars_[radar].scans.push_back(
          {scan.stamp_us, {targets_.begin(), targets_.end()}, told_yaw_rate_radps(radar, scan)});
    }
  }

  void on_motion(std::size_t radar, const EgoMotion& motion, std::int32_t) override {
    if (motion.has_estimate()) {
      radars_[radar].motions.push_back(motion);
    }
  }

  /// Clusters only: an object's velocity across is measured.
  [[nodiscard]] double told_yaw_rate_radps(std::size_t radar, const RadarScan& scan) const {
    const auto* ars408 = configuration_.radars[radar].decoder.as<Ars408Options>();
    return ars408 != nullptr && ars408->output == Ars408Output::clusters
               ? reported_yaw_rate_radps(scan)
               : 0.0;
  }

  std::vector<RecordedRadar> take() { return std::move(radars_); }

 private:
  const Configuration& configuration_;
  std::vector<RecordedRadar> radars_;
  TargetSet targets_;
  SelectionCounters counters_;
};

void check_logs(const Replay& replay) {
  for (const auto& log : replay.logs()) {
    if (const std::string problem = log->reader().problem(); !problem.empty()) {
      throw std::runtime_error(problem);
    }
  }
}

}  // namespace

void play_drive(const Configuration& configuration, const std::vector<std::string>& logs,
                const std::vector<OdometrySink*>& sinks) {
  require_interface_names(configuration);
  const volatile std::sig_atomic_t stop = 0;
  std::vector<std::unique_ptr<CandumpLog>> sources;
  sources.reserve(logs.size());
  for (const std::string& path : logs) {
    sources.push_back(std::make_unique<CandumpLog>(path, interface_names(configuration), &stop));
  }
  Replay replay(std::move(sources), 0.0, &stop);
  Pipeline pipeline(configuration, replay, sinks, {});
  while (pipeline.take_next(replay)) {
  }
  pipeline.finish();
  check_logs(replay);
}

std::vector<RecordedRadar> record_drive(const Configuration& configuration,
                                        const std::vector<std::string>& logs,
                                        std::vector<OdometrySink*> sinks) {
  RecordingSink sink(configuration);
  sinks.push_back(&sink);
  play_drive(configuration, logs, sinks);
  std::vector<RecordedRadar> radars = sink.take();
  if (std::ranges::all_of(radars, [](const auto& r) { return r.scans.empty(); })) {
    throw std::runtime_error(
        concat({logs.front(), ": no complete scan of any radar; `cremed-doctor --replay ",
                in_shell(logs.front()), "` tells why"}));
  }
  return radars;
}

}  // namespace cremed
