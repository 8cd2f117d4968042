// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cremed/estimator/fusion/state/pose_chain.hpp"
#include "cremed/estimator/scan/degrees.hpp"
#include "test/faults/fault_case.hpp"
#include "tools/eval/credibility.hpp"

namespace cremed::test {

/// How often one radar was believed.
struct RadarFigures {
  double left_out = 0.0;                ///< Share of the time it was excluded by the odometry.
  double doubted = 0.0;                 ///< Share of the time it had a doubt in its status.
  double named = 0.0;                   ///< Share of the time of either.
  std::uint32_t doubts = 0;             ///< All doubts it had.
  double availability = 0.0;            ///< Share of its scans with an estimate.
  std::optional<double> named_after_s;  ///< First time named since the fault began.
  std::array<int, 9> causes{};          ///< Statuses that name a cause, by FaultKind.
  FaultCause cause;                     ///< Last named.
};

/// Result of a drive with a systematic fault. Shares of time and of rows count from the beginning
/// of the fault.
struct DriveFigures {
  std::size_t usable = 0;  ///< Rows of the odometry with status ok or standing_still.
  std::size_t beyond = 0;  ///< Of these, errors beyond 5 sigma.
  double worst_sigmas = 0.0;
  /// Shares of the time by status; the last is the time without odometry.
  std::array<double, kOdometryStatusCount + 1> status{};
  /// Largest error of the pose since the start of a window of 10 s, all of it usable.
  double window_m = 0.0;
  double window_deg = 0.0;
  std::size_t windows = 0;
  /// Largest error of the pose since the start, in sigma, of usable rows.
  double odom_sigmas = 0.0;
  std::vector<RadarFigures> radars;
  /// From the fault's end to the first second that is all usable and within 5 sigma; none: never.
  std::optional<double> recovery_s;

  [[nodiscard]] double beyond_share() const {
    return usable == 0 ? 0.0 : static_cast<double>(beyond) / static_cast<double>(usable);
  }
  [[nodiscard]] double status_share(OdometryStatus of) const {
    return status[static_cast<std::size_t>(of)];
  }
};

/// Judges what is published of a drive with a fault.
class DriveJudge {
 public:
  static constexpr double kMaxSigma = 5.0;

  DriveJudge(const FaultDrive& drive, const FaultCase& fault, const FaultRecord& record)
      : drive_(drive), fault_(fault), record_(record) {
    for (std::size_t i = 0; i < record.sink.odometries.size(); ++i) {
      rows_.push_back(row(i));
    }
  }

  /// A line for each row of the odometry: time in s, status, largest error in sigma, velocity
  /// (m/s, degrees per s) with its standard deviation, bits of the radars used and left out.
  void print_rows() const {
    for (const Row& row : rows_) {
      const Odometry& odometry = *row.odometry;
      std::printf("%8.3f %-14s %7.1f | v %6.2f w %6.2f std %5.2f %5.1f | used %2x left out %2x\n",
                  static_cast<double>(row.us - drive_.start_us()) / kUsPerS,
                  std::string(to_string(odometry.status)).c_str(), row.sigmas.value_or(0.0),
                  odometry.twist.x(), kDegPerRad * odometry.twist.z(),
                  std::sqrt(odometry.twist_covariance(0, 0)),
                  kDegPerRad * std::sqrt(odometry.twist_covariance(2, 2)), odometry.radars,
                  odometry.left_out);
    }
  }

  [[nodiscard]] DriveFigures figures() const {
    DriveFigures figures;
    count_rows(figures);
    count_time(figures);
    count_windows(figures);
    count_odom(figures);
    for (std::size_t i = 0; i < record_.sink.motions.size(); ++i) {
      figures.radars.push_back(radar(i));
    }
    if (fault_.ends()) {
      figures.recovery_s = recovery();
    }
    return figures;
  }

 private:
  /// A row of the odometry on truth's clock.
  struct Row {
    const Odometry* odometry;
    std::int64_t us;
    bool is_after_step;            ///< Of the computer's clock.
    std::optional<double> sigmas;  ///< Of the largest error of the pose since the anchor.

    [[nodiscard]] bool is_good() const {
      return odometry->is_usable() && (!sigmas || *sigmas <= kMaxSigma);
    }
  };

  static constexpr double kUsPerS = 1e6;
  /// A row stands for at most that long.
  static constexpr std::int64_t kRowUs = 200'000;
  /// Above the wait for scans of the other radars, 75 ms, and the time of a scan.
  static constexpr std::int64_t kHeldUs = 200'000;
  static constexpr std::int64_t kWindowUs = 10'000'000;
  static constexpr std::int64_t kWindowStepUs = 500'000;

  Row row(std::size_t index) {
    const Odometry& odometry = record_.sink.odometries[index];
    const bool is_after = is_after_step(odometry, record_.given[index]);
    const std::int64_t step_us = is_after ? record_.given[index].clock_step_us : 0;
    Row result{&odometry, odometry.utime_us - step_us, is_after, std::nullopt};
    const auto anchor = true_us_.find(odometry.utime_anchor_us);
    const std::int64_t anchor_us =
        anchor != true_us_.end() ? anchor->second : odometry.utime_anchor_us - step_us;
    true_us_[odometry.utime_us] = result.us;
    if (const auto truth = drive_.truth.motion(anchor_us, result.us)) {
      result.sigmas = sigmas(odometry, *truth, anchor_us, result.us);
    }
    return result;
  }

  /// Whether its stamps are of the clock after the step. Scans from before it may be published
  /// after it, for kHeldUs.
  [[nodiscard]] bool is_after_step(const Odometry& odometry,
                                   const FaultRecord::Given& given) const {
    const std::int64_t new_us = fault_.time.from_us + given.clock_step_us;
    if (given.clock_step_us > 0) {
      return odometry.utime_us >= new_us;
    }
    const bool is_back = !rows_.empty() && (rows_.back().is_after_step ||
                                            odometry.utime_us < rows_.back().odometry->utime_us);
    return is_back || given.frame_us > new_us + kHeldUs;
  }

  [[nodiscard]] double sigmas(const Odometry& odometry, const Eigen::Vector3d& truth,
                              std::int64_t from_us, std::int64_t to_us) const {
    const std::int64_t interval_us = std::abs(to_us - from_us);
    Eigen::Vector3d sigmas =
        sigmas_by_axis(odometry, truth, drive_.truth_noise.covariance(interval_us).diagonal());
    if (const auto wheels = drive_.wheels ? drive_.wheels->motion(from_us, to_us) : std::nullopt) {
      const double interval_s = static_cast<double>(interval_us) / kUsPerS;
      const WheelStd& std = drive_.wheels->std();
      const Eigen::Vector3d by_wheels =
          sigmas_by_axis(odometry, *wheels,
                         interval_s * interval_s *
                             Eigen::Vector3d(std.speed_mps, 0.0, std.yaw_rate_radps).cwiseAbs2());
      for (const int axis : {0, 2}) {  // Of y the wheels tell nothing.
        sigmas(axis) = std::min(sigmas(axis), by_wheels(axis));
      }
    }
    return sigmas.maxCoeff();
  }

  static Eigen::Vector3d sigmas_by_axis(const Odometry& odometry, const Eigen::Vector3d& reference,
                                        const Eigen::Vector3d& variance_of_reference) {
    const Eigen::Vector3d error = estimation_error(odometry.pose, reference);
    Eigen::Vector3d sigmas = Eigen::Vector3d::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      const double variance = odometry.covariance(axis, axis);
      if (variance > 0.0) {
        sigmas(axis) = std::abs(error(axis)) / std::sqrt(variance + variance_of_reference(axis));
      }
    }
    return sigmas;
  }

  [[nodiscard]] std::int64_t end_us() const { return drive_.frames.back().stamp_us; }
  [[nodiscard]] double fault_s() const {
    return static_cast<double>(end_us() - fault_.time.from_us) / kUsPerS;
  }

  void count_rows(DriveFigures& figures) const {
    for (const Row& row : rows_) {
      if (row.us < fault_.time.from_us || !row.odometry->is_usable() || !row.sigmas) continue;
      ++figures.usable;
      figures.beyond += row.is_good() ? 0 : 1;
      figures.worst_sigmas = std::max(figures.worst_sigmas, *row.sigmas);
    }
  }

  /// Seconds of [from_us, to_us) in the fault's time and after.
  [[nodiscard]] double seconds(std::int64_t from_us, std::int64_t to_us) const {
    const std::int64_t begin_us = std::max(from_us, fault_.time.from_us);
    const std::int64_t until_us = std::min(to_us, end_us());
    return static_cast<double>(std::max<std::int64_t>(0, until_us - begin_us)) / kUsPerS;
  }
  /// That a row stands for.
  [[nodiscard]] double seconds_of(std::size_t index) const {
    const std::int64_t next_us = index + 1 < rows_.size() ? rows_[index + 1].us : end_us();
    return seconds(rows_[index].us, std::min(next_us, rows_[index].us + kRowUs));
  }

  void count_time(DriveFigures& figures) const {
    double all = 0.0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const double share = seconds_of(i) / fault_s();
      figures.status[static_cast<std::size_t>(rows_[i].odometry->status)] += share;
      all += share;
    }
    figures.status.back() = std::max(0.0, 1.0 - all);
  }

  void count_windows(DriveFigures& figures) const {
    for (std::size_t first = 0; first < rows_.size(); ++first) {
      if (first > 0 && rows_[first].us / kWindowStepUs == rows_[first - 1].us / kWindowStepUs) {
        continue;
      }
      std::size_t last = first;
      while (last < rows_.size() && rows_[last].odometry->is_usable() &&
             rows_[last].us < rows_[first].us + kWindowUs) {
        ++last;
      }
      if (last == rows_.size() || !rows_[last].odometry->is_usable()) continue;
      const auto truth = drive_.truth.motion(rows_[first].us, rows_[last].us);
      if (!truth || rows_[last].us < fault_.time.from_us) continue;
      const Eigen::Vector3d error = estimation_error(
          relative_pose(rows_[first].odometry->odom_pose, rows_[last].odometry->odom_pose), *truth);
      ++figures.windows;
      figures.window_m = std::max(figures.window_m, error.head<2>().norm());
      figures.window_deg = std::max(figures.window_deg, kDegPerRad * std::abs(error.z()));
    }
  }

  /// Truth begins at the first usable row, whose pose since the start is nearly certain.
  void count_odom(DriveFigures& figures) const {
    const auto first = std::find_if(rows_.begin(), rows_.end(),
                                    [](const Row& row) { return row.odometry->is_usable(); });
    for (auto row = first; row != rows_.end(); ++row) {
      const Odometry& odometry = *row->odometry;
      const auto truth = drive_.truth.motion(first->us, row->us);
      if (!odometry.is_usable() || !truth || row->us < fault_.time.from_us) continue;
      const Eigen::Vector3d error =
          estimation_error(odometry.odom_pose, composed_pose(first->odometry->odom_pose, *truth));
      const Eigen::Vector3d variance =
          odometry.odom_covariance.diagonal() +
          drive_.truth_noise.covariance(std::abs(row->us - first->us)).diagonal();
      figures.odom_sigmas = std::max(
          figures.odom_sigmas, (error.cwiseAbs2().cwiseQuotient(variance)).cwiseSqrt().maxCoeff());
    }
  }

  [[nodiscard]] RadarFigures radar(std::size_t index) const {
    RadarFigures figures;
    const auto& motions = record_.sink.motions[index];
    const auto with_estimate = std::count_if(motions.begin(), motions.end(),
                                             [](const auto& each) { return each.has_estimate(); });
    figures.availability =
        motions.empty() ? 0.0
                        : static_cast<double>(with_estimate) / static_cast<double>(motions.size());
    // Intervals in which it was named, on truth's clock.
    std::map<std::int64_t, std::int64_t> named;
    const auto name = [&](std::int64_t from_us, std::int64_t to_us, double& share) {
      share += seconds(from_us, to_us) / fault_s();
      if (to_us > fault_.time.from_us) {
        named[from_us] = std::max(named[from_us], to_us);
      }
    };
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if ((rows_[i].odometry->left_out >> index & 1U) != 0 && !is_dispute(*rows_[i].odometry)) {
        const std::int64_t next_us = i + 1 < rows_.size() ? rows_[i + 1].us : end_us();
        name(rows_[i].us, std::min(next_us, rows_[i].us + kRowUs), figures.left_out);
      }
    }
    const auto& statuses = record_.sink.statuses[index];
    for (std::size_t i = 0; i < statuses.size(); ++i) {
      if (statuses[i].utime_us >= fault_.time.from_us) {
        figures.doubts |= statuses[i].belief.doubts;
      }
      if (const FaultCause& cause = statuses[i].odometry.cause; cause.kind != FaultKind::unknown) {
        ++figures.causes.at(static_cast<std::size_t>(cause.kind));
        figures.cause = cause;
      }
      if (statuses[i].belief.doubts != 0 &&
          !(statuses[i].belief.doubts == other_radars_contradict &&
            is_dispute_near(statuses[i].utime_us))) {
        name(statuses[i].utime_us, i + 1 < statuses.size() ? statuses[i + 1].utime_us : end_us(),
             figures.doubted);
      }
    }
    std::int64_t until_us = fault_.time.from_us;
    for (const auto& [from_us, to_us] : named) {
      if (!figures.named_after_s) {
        figures.named_after_s =
            static_cast<double>(std::max(from_us, until_us) - fault_.time.from_us) / kUsPerS;
      }
      figures.named += seconds(std::max(from_us, until_us), to_us) / fault_s();
      until_us = std::max(until_us, to_us);
    }
    return figures;
  }

  /// The only two radars that can tell contradict each other: which is wrong is not known, and
  /// neither is named.
  [[nodiscard]] bool is_dispute(const Odometry& odometry) const {
    std::uint32_t judged = 0;
    for (std::size_t i = 0; i < drive_.radars.size(); ++i) {
      judged |= drive_.is_side(i) ? 0U : 1U << i;
    }
    return std::popcount(judged) == 2 && (odometry.left_out & judged) == judged;
  }
  /// A status may be told some scans before or after the row that it belongs to.
  [[nodiscard]] bool is_dispute_near(std::int64_t us) const {
    return std::any_of(rows_.begin(), rows_.end(), [&](const Row& row) {
      return std::abs(row.odometry->utime_us - us) < kRowUs && is_dispute(*row.odometry);
    });
  }

  [[nodiscard]] std::optional<double> recovery() const {
    constexpr std::int64_t kGoodUs = 1'000'000;
    std::int64_t good_us = kNever;
    for (const Row& row : rows_) {
      if (row.us < fault_.end_us()) continue;
      good_us = row.is_good() ? std::min(good_us, row.us) : kNever;
      if (row.us - good_us >= kGoodUs) {
        return static_cast<double>(good_us - fault_.end_us()) / kUsPerS;
      }
    }
    return std::nullopt;
  }

  const FaultDrive& drive_;
  const FaultCase& fault_;
  const FaultRecord& record_;
  std::vector<Row> rows_;
  std::map<std::int64_t, std::int64_t> true_us_;  // Of an output's stamp, the latest.
};

inline DriveFigures judged(const FaultDrive& drive, const FaultCase& fault) {
  const FaultRecord result = record(drive, fault, false);
  return DriveJudge(drive, fault, result).figures();
}

}  // namespace cremed::test
