// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "cremed/estimator/motion/doppler_velocity.hpp"
#include "cremed/estimator/scan/pose2.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Checks scale and sign of a radar's Doppler by the positions of its targets. Two scans are
/// compared between which the vehicle drove some metres by Doppler. If the Doppler is right but for
/// its scale, the targets of the first are found in the second at (1 + r) times that way, with one
/// r for all static targets. Each pair of targets that fits across the way votes for its r, without
/// association or start value; the votes of moving targets and of chance pairs are spread evenly.
/// With the wrong sign they are found the same way back.
///
/// On healthy drives the r with most votes is within 0.02 in nine of ten comparisons. A larger one
/// has more votes than r = 0 by 1.2 sigma at most, in the first comparisons after a start by 1.56;
/// with a Doppler scale of 0.95 by 1.5 to 4 (medians of the front radars of 0061, 0103, 1094,
/// RadarScenes 105, each alone), with 0.9 by 5 to 7. r is then 0.03 to 0.07 and 0.09 to 0.13 in
/// nine of ten, on 1094 at walking pace up to 0.18. In tight turns it is up to 0.08 on healthy
/// drives: more is allowed there.
class DopplerScale {
 public:
  explicit DopplerScale(const Pose2& vehicle_from_radar) : mount_(vehicle_from_radar) {}

  /// Adds the targets of the next scan. `yaw_rate_radps`: since the previous one.
  void add(const TargetSet& targets, double yaw_rate_radps, std::int64_t stamp_us);
  /// To be called when the clock of the stamps was set.
  void forget();
  /// The votes so far tell nothing: others have the speed of the Doppler, or it changed.
  void acquit() {
    forget();
    is_wrong_ = false;
  }

  /// The Doppler has another scale or sign than the positions: begins and ends with clear votes.
  [[nodiscard]] bool is_wrong() const { return is_wrong_; }
  /// (1 + r) or -1, by which the Doppler would have to be multiplied; of the latest clear votes.
  [[nodiscard]] double correction() const { return correction_; }

 private:
  static constexpr std::size_t kScans = 16;
  static constexpr std::size_t kMaxTargets = 128;
  static constexpr int kMaxShareSteps = 30;  // Largest r that is searched for, in steps of 0.01.
  static constexpr int kMiddle = 45;
  static constexpr std::size_t kSteps = 2 * kMiddle + 1;

  using Votes = std::array<double, kSteps>;

  struct Point {
    Eigen::Vector2d m;  // From the sensor, in the axes of the vehicle.
    double side_variance_m2 = 0.0;
  };
  struct Scan {
    std::int64_t stamp_us = 0;
    Eigen::Vector2d way_m = Eigen::Vector2d::Zero();  // Of the sensor, by Doppler.
    double yaw_rad = 0.0;
    std::size_t size = 0;
    std::array<Point, kMaxTargets> points;
  };

  [[nodiscard]] Scan& scan(std::size_t age) { return scans_[(newest_ + kScans - age) % kScans]; }
  void advance(const Eigen::Vector2d& velocity_mps, double yaw_rate_radps, std::int64_t stamp_us);
  void take(const TargetSet& targets, Scan& to);
  void vote(const Scan& from, const Scan& to, const Eigen::Vector2d& way_m);
  void judge(double way_m);

  Pose2 mount_;
  DopplerVelocityEstimator doppler_;
  TargetSet fixed_;
  Eigen::Vector2d velocity_mps_ = Eigen::Vector2d::Zero();
  std::array<Scan, kScans> scans_;
  Votes votes_{};               // For ways (1 + r) times that by Doppler,
  Votes reversed_{};            // and for -(1 + r) times.
  double share_by_turn_ = 0.0;  // In turns healthy radars have r up to this, besides.
  std::size_t newest_ = 0;
  std::size_t count_ = 0;
  double correction_ = 1.0;
  bool is_wrong_ = false;
};

}  // namespace cremed
