// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "cremed/estimator/doubt/radar/speed_jump.hpp"
#include "cremed/estimator/motion/doppler_velocity.hpp"
#include "cremed/estimator/scan/pose2.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Checks scale and sign of a radar's Doppler by the positions of its targets. Two scans are
/// compared between which the vehicle drove some metres. By Doppler it drove a certain way; by
/// positions the static targets moved by (1 + r) times that way, with one r for all of them. Each
/// pair of targets, one of each scan, that fits across the way votes for its r, without association
/// or start value. Votes of moving targets and of chance pairs are spread evenly. If the sign of
/// Doppler is wrong, static targets moved by -(1 + r) times the way.
///
/// On healthy drives the r with most votes is within 0.02 in nine of ten comparisons. A larger r
/// has more votes than r = 0 by 1.2 sigma at most, in the first comparisons after a start by 1.56.
/// With a Doppler scale of 0.95 it is 1.5 to 4 sigma (medians of the front radars of 0061, 0103,
/// 1094, RadarScenes 105, each alone), with 0.9 it is 5 to 7. The r with most votes is then 0.03 to
/// 0.07 and 0.09 to 0.13 in nine of ten comparisons, on 1094 at walking pace up to 0.18. In tight
/// turns healthy drives reach r = 0.08: more is allowed there.
class DopplerScale {
 public:
  explicit DopplerScale(const Pose2& vehicle_from_radar) : mount_(vehicle_from_radar) {}

  /// Adds the targets of the next scan. `yaw_rate_radps`: since the previous one.
  void add(const TargetSet& targets, double yaw_rate_radps, std::int64_t stamp_us);
  /// To be called when the clock of the stamps was set.
  void forget();
  /// Discards votes and verdict: other radars confirm the speed by Doppler, or Doppler stepped or
  /// jumped.
  void acquit() {
    forget();
    is_wrong_ = false;
  }

  /// Doppler has another scale or sign than the positions. Changes only with clear votes.
  [[nodiscard]] bool is_wrong() const { return is_wrong_; }
  /// While driving, too few scans were compared since the start, or since Doppler jumped.
  [[nodiscard]] bool is_open() const;
  /// Factor that corrects Doppler by the latest clear votes: 1 + r, or -1.
  [[nodiscard]] double correction() const { return correction_; }

 private:
  static constexpr std::size_t kScans = 16;
  static constexpr std::size_t kMaxTargets = 128;
  // The r that are searched for, in steps of 0.01: Doppler scales from 1.6 to 0.6.
  static constexpr int kMinShareSteps = -38;
  static constexpr int kMaxShareSteps = 67;
  static constexpr int kMargin = 15;                        // Of votes on both sides of these.
  static constexpr int kMiddle = kMargin - kMinShareSteps;  // Index of r = 0.
  static constexpr std::size_t kSteps = kMiddle + kMaxShareSteps + kMargin + 1;

  using Votes = std::array<double, kSteps>;

  struct Point {
    Eigen::Vector2d m;  // From the sensor, in the axes of the vehicle.
    double side_variance_m2 = 0.0;
  };
  struct Scan {
    std::int64_t stamp_us = 0;
    Eigen::Vector2d way_m = Eigen::Vector2d::Zero();  // Place of the sensor, by Doppler.
    double yaw_rad = 0.0;
    std::size_t size = 0;
    std::array<Point, kMaxTargets> points;
  };

  [[nodiscard]] Scan& scan(std::size_t age) { return scans_[(newest_ + kScans - age) % kScans]; }
  [[nodiscard]] bool is_driving() const;
  void advance(const Eigen::Vector2d& velocity_mps, double yaw_rate_radps, std::int64_t stamp_us);
  void take(const TargetSet& targets, Scan& to);
  void vote(const Scan& from, const Scan& to, const Eigen::Vector2d& way_m);
  void judge(double way_m);

  Pose2 mount_;
  DopplerVelocityEstimator doppler_;
  SpeedJump jumps_;
  TargetSet fixed_;
  Eigen::Vector2d velocity_mps_ = Eigen::Vector2d::Zero();
  std::array<Scan, kScans> scans_;
  Votes votes_{};               // For (1 + r) times the way by Doppler.
  Votes reversed_{};            // For -(1 + r) times the way.
  double share_by_turn_ = 0.0;  // Added to the limit of r in turns.
  std::size_t newest_ = 0;
  std::size_t count_ = 0;
  int compared_ = 0;  // Comparisons that votes_ are of.
  int awaited_ = 0;   // Scans since then while driving.
  double correction_ = 1.0;
  bool is_wrong_ = false;
};

}  // namespace cremed
