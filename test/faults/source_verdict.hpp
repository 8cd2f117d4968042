// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "cremed/estimator/fusion/state/pose_chain.hpp"
#include "test/faults/fault_drive.hpp"
#include "test/faults/frame_faults.hpp"
#include "tools/eval/credibility.hpp"

namespace cremed::test {

inline constexpr double kMaxSigmas = 5.0;
inline constexpr std::int64_t kWholeAfterUs = 1'000'000;

/// Sums of squared errors of estimates.
struct SquaredErrors {
  std::size_t count = 0;
  double x_m2 = 0.0;
  double yaw_rad2 = 0.0;

  void add(const Eigen::Vector3d& error) {
    ++count;
    x_m2 += error.x() * error.x();
    yaw_rad2 += error.z() * error.z();
  }
  SquaredErrors& operator+=(const SquaredErrors& other) {
    count += other.count;
    x_m2 += other.x_m2;
    yaw_rad2 += other.yaw_rad2;
    return *this;
  }
  [[nodiscard]] double rmse_x_m() const { return std::sqrt(x_m2 / static_cast<double>(count)); }
  [[nodiscard]] double rmse_rad() const { return std::sqrt(yaw_rad2 / static_cast<double>(count)); }
};

/// Result of one source in one drive.
struct SourceVerdict {
  std::string source;
  bool is_side = false;       ///< A lateral radar ...
  bool is_doubted = false;    ///< ... whose last status has a doubt.
  std::size_t estimates = 0;  ///< Published as usable.
  std::size_t beyond = 0;     ///< Errors beyond kMaxSigmas of their own sigma and truth's.
  /// Of the estimates, those that end a second or more after the fault's end.
  std::size_t after = 0;
  std::size_t beyond_after = 0;  ///< Of the errors beyond, those that begin then.
  SquaredErrors errors;
  SquaredErrors errors_of_odometry;  ///< At the same times. For radars only.

  /// RMSE of the odometry over its own. Without y: with two degrees of freedom a radar assumes 0,
  /// which is exact in a simulation without slip but not known to any sensor.
  [[nodiscard]] double ratio_x() const { return errors_of_odometry.rmse_x_m() / errors.rmse_x_m(); }
  [[nodiscard]] double ratio_yaw() const {
    return errors_of_odometry.rmse_rad() / errors.rmse_rad();
  }
};

/// Judges the output of a drive with a fault.
class Judge {
 public:
  Judge(const FaultDrive& drive, FaultTime fault) : drive_(drive), fault_(fault) {}

  /// `front_ahead_us`: offset of the first radar's clock to truth during the fault. Its motions are
  /// correct by its own clock, the only one it knows.
  [[nodiscard]] std::vector<SourceVerdict> all(const RecordingSink& sink,
                                               std::int64_t front_ahead_us) const {
    std::vector<SourceVerdict> verdicts;
    for (std::size_t i = 0; i < drive_.radars.size(); ++i) {
      verdicts.push_back(radar(sink, i, i == 0 ? front_ahead_us : 0));
    }
    verdicts.push_back(motions("fused", sink.fused, 0));
    verdicts.push_back(odometry(sink));
    return verdicts;
  }

 private:
  [[nodiscard]] SourceVerdict radar(const RecordingSink& sink, std::size_t index,
                                    std::int64_t ahead_us) const {
    SourceVerdict verdict = motions(drive_.radars[index].name, sink.motions[index], ahead_us);
    verdict.is_side = drive_.is_side(index);
    verdict.is_doubted =
        !sink.statuses[index].empty() && sink.statuses[index].back().belief.doubts != 0;
    std::map<std::int64_t, Eigen::Vector3d> poses;
    for (const Odometry& odometry : sink.odometries) {
      if (odometry.is_usable()) poses[odometry.utime_us] = odometry.odom_pose;
    }
    SquaredErrors of_radar;
    for (const EgoMotion& motion : sink.motions[index]) {
      const auto truth = drive_.truth.motion(motion.utime_start_us, motion.utime_us);
      const auto start = poses.find(motion.utime_start_us);
      const auto end = poses.find(motion.utime_us);
      if (motion.has_estimate() && truth && start != poses.end() && end != poses.end()) {
        of_radar.add(estimation_error(motion.motion, *truth));
        verdict.errors_of_odometry.add(
            estimation_error(relative_pose(start->second, end->second), *truth));
      }
    }
    verdict.errors = of_radar;
    return verdict;
  }

  [[nodiscard]] SourceVerdict motions(const std::string& source,
                                      const std::vector<EgoMotion>& motions,
                                      std::int64_t ahead_us) const {
    SourceVerdict verdict;
    verdict.source = source;
    for (const EgoMotion& motion : motions) {
      if (motion.has_estimate()) {
        add(verdict, true_us(motion.utime_start_us, ahead_us), true_us(motion.utime_us, ahead_us),
            motion.motion, motion.covariance);
      }
    }
    return verdict;
  }

  [[nodiscard]] std::int64_t true_us(std::int64_t stamp_us, std::int64_t ahead_us) const {
    return stamp_us < fault_.until_us + ahead_us ? stamp_us - ahead_us : stamp_us;
  }

  /// The pose relative to the anchor.
  [[nodiscard]] SourceVerdict odometry(const RecordingSink& sink) const {
    SourceVerdict verdict;
    verdict.source = "odometry";
    for (const Odometry& odometry : sink.odometries) {
      if (odometry.is_usable()) {
        add(verdict, odometry.utime_anchor_us, odometry.utime_us, odometry.pose,
            odometry.covariance);
      }
    }
    return verdict;
  }

  void add(SourceVerdict& verdict, std::int64_t start_us, std::int64_t end_us,
           const Eigen::Vector3d& motion, const Eigen::Matrix3d& covariance) const {
    const auto truth = drive_.truth.motion(start_us, end_us);
    if (!truth) return;
    const Eigen::Vector3d error = estimation_error(motion, *truth);
    const Eigen::Matrix3d noise = drive_.truth_noise.covariance(end_us - start_us);
    bool is_beyond = false;
    for (int axis = 0; axis < 3; ++axis) {
      // With two degrees of freedom y is not estimated.
      const bool is_estimated = covariance(axis, axis) > 0.0;
      const double sigma = std::sqrt(covariance(axis, axis) + noise(axis, axis));
      is_beyond = is_beyond || (is_estimated && std::abs(error(axis)) > kMaxSigmas * sigma);
    }
    const bool is_after = fault_.until_us <= start_us - kWholeAfterUs;
    ++verdict.estimates;
    verdict.beyond += is_beyond ? 1 : 0;
    verdict.after += fault_.until_us <= end_us - kWholeAfterUs ? 1 : 0;
    verdict.beyond_after += is_after && is_beyond ? 1 : 0;
    verdict.errors.add(error);
  }

  const FaultDrive& drive_;
  FaultTime fault_;
};

}  // namespace cremed::test
