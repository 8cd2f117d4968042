// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A simulated drive through the whole pipeline, in memory.

#include <algorithm>
#include <cstdint>
#include <sstream>
#include <vector>

#include "daemon/pipeline.hpp"
#include "test/tools/simulated_drive.hpp"
#include "tools/eval/credibility.hpp"
#include "tools/eval/drive/true_trajectory.hpp"

namespace cremed::test {

/// Keeps all results; the scans, 20 kB each, if `keeps_scans`.
class RecordingSink final : public OdometrySink {
 public:
  explicit RecordingSink(std::size_t radars, bool keeps_scans = true)
      : motions(radars), statuses(radars), scans(keeps_scans ? radars : 0) {}

  void on_scan(std::size_t radar, const RadarScan& scan) override {
    if (!scans.empty()) scans[radar].push_back(scan);
  }
  void on_motion(std::size_t radar, const EgoMotion& motion, std::int32_t solve_us) override {
    motions[radar].push_back(motion);
    max_solve_us = std::max(max_solve_us, solve_us);
  }
  void on_odometry(const Odometry& odometry) override { odometries.push_back(odometry); }
  void on_fused(const EgoMotion& motion, std::int32_t) override { fused.push_back(motion); }
  void on_status(std::size_t radar, const RadarStatus& status) override {
    statuses[radar].push_back(status);
  }

  std::vector<std::vector<EgoMotion>> motions;
  std::int32_t max_solve_us = 0;
  std::vector<Odometry> odometries;
  std::vector<EgoMotion> fused;
  std::vector<std::vector<RadarStatus>> statuses;
  std::vector<std::vector<RadarScan>> scans;
};

class NoSource final : public FrameSource {
 public:
  SourceEvent next(CanFrame&) override { return SourceEvent::end; }
};
inline const NoSource kNoSource{};

inline void play(const std::vector<CanFrame>& frames, Pipeline& pipeline) {
  for (const CanFrame& frame : frames) {
    pipeline.on_frame(frame);
  }
  pipeline.finish();
}

inline Configuration configuration_of(const std::vector<RadarConfiguration>& radars) {
  Configuration configuration;
  configuration.radars = radars;
  return configuration;
}

inline RecordingSink run_pipeline(const std::vector<RadarConfiguration>& radars,
                                  const std::vector<CanFrame>& frames) {
  RecordingSink sink(radars.size());
  Pipeline pipeline(configuration_of(radars), kNoSource, {&sink}, {});
  play(frames, pipeline);
  return sink;
}

inline TrueTrajectory truth_of(const Drive& drive) {
  std::istringstream csv(drive.truth_csv);
  return TrueTrajectory(csv);
}

/// Compares estimates with truth.
inline void add(Credibility& credibility, const std::vector<EgoMotion>& motions,
                const TrueTrajectory& truth) {
  for (const EgoMotion& motion : motions) {
    const auto true_motion = truth.motion(motion.utime_start_us, motion.utime_us);
    if (motion.has_estimate() && true_motion) {
      credibility.add(motion.motion, motion.covariance, *true_motion);
    }
  }
}

/// The same of one drive, 2 DoF.
inline Credibility credibility_of(const std::vector<EgoMotion>& motions,
                                  const TrueTrajectory& truth) {
  Credibility credibility(2);
  add(credibility, motions, truth);
  return credibility;
}

inline std::size_t count_status(const std::vector<EgoMotion>& motions, MotionStatus status) {
  return static_cast<std::size_t>(std::ranges::count_if(
      motions, [&](const EgoMotion& motion) { return motion.status == status; }));
}

}  // namespace cremed::test
