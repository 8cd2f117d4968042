// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/trajectory_segments.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include <Eigen/Cholesky>

#include "cremed/estimator/scan/stamps.hpp"
#include "daemon/output/text_line.hpp"
#include "tools/eval/credibility.hpp"
#include "tools/eval/drive/motion_chain.hpp"
#include "tools/eval/drive/pose_windows.hpp"

namespace cremed {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

constexpr std::array kLengths{SegmentLength{10.0, kNoLimit},  SegmentLength{50.0, kNoLimit},
                              SegmentLength{100.0, kNoLimit}, SegmentLength{kNoLimit, 1.0},
                              SegmentLength{kNoLimit, 5.0},   SegmentLength{kNoLimit, 10.0},
                              SegmentLength{kNoLimit, 30.0}};

/// In 2 degrees of freedom y has no variance; a micrometre makes the matrix invertible.
constexpr double kLeastVarianceM2 = 1e-12;

/// First motion of each begin.
std::vector<std::size_t> begins(const std::vector<RecordedEstimate>& estimates) {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    if (i == 0 || estimates[i].start_us != estimates[i - 1].start_us) {
      result.push_back(i);
    }
  }
  return result;
}

/// Every anchor, or the first estimate in each window.
std::vector<std::size_t> chain_begins(const std::vector<RecordedEstimate>& estimates,
                                      std::int64_t first_window_us) {
  std::vector<std::size_t> all = begins(estimates);
  if (all.size() < estimates.size()) {
    return all;
  }
  std::vector<std::size_t> result;
  std::int64_t window_us = first_window_us;
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    if (estimates[i].start_us >= window_us) {
      result.push_back(i);
      const std::int64_t windows = (estimates[i].start_us - window_us) / kWindowStepUs;
      window_us += (windows + 1) * kWindowStepUs;
    }
  }
  return result;
}

class LengthErrors {
 public:
  explicit LengthErrors(const SegmentLength& length) { errors_.length = length; }

  /// Whether the growing segment is shorter.
  [[nodiscard]] bool is_open() const { return is_open_; }
  void open() { is_open_ = true; }

  /// `before`: the chain without its last estimate.
  void close_if_long_enough(const MotionChain& chain, const MotionChain& before,
                            std::int64_t begin_us, const TrueTrajectory& truth,
                            const TruthNoise& noise) {
    const double time_s = seconds_between(begin_us, chain.end_us());
    if (chain.driven_m() < errors_.length.way_m && time_s < errors_.length.time_s) {
      return;
    }
    is_open_ = false;
    const double time_before_s = seconds_between(begin_us, before.end_us());
    const double wanted_s = errors_.length.time_s;
    const bool is_before_nearer =
        wanted_s < kNoLimit && wanted_s - time_before_s < time_s - wanted_s;
    const MotionChain& nearest = is_before_nearer ? before : chain;
    if (nearest.end_us() > begin_us) {  // Else there is no row near that time.
      add(nearest, begin_us, truth, noise);
    }
  }

  /// `windows`: of that time; nothing for a distance.
  [[nodiscard]] SegmentErrors mean(const std::optional<WindowErrors>& windows) const {
    SegmentErrors mean = errors_;
    const double count = divisor(mean.chains);
    mean.anees /= count;
    mean.nees /= count;
    mean.segments = windows ? windows->windows : mean.chains;
    mean.rmse = windows ? windows->rmse : (mean.rmse / count).cwiseSqrt();
    mean.position_percent = windows ? windows->position_percent : mean.position_percent / count;
    return mean;
  }

  [[nodiscard]] const SegmentLength& length() const { return errors_.length; }

 private:
  void add(const MotionChain& chain, std::int64_t begin_us, const TrueTrajectory& truth,
           const TruthNoise& noise) {
    const auto motion = truth.motion(begin_us, chain.end_us());
    if (!motion) {
      return;
    }
    const Eigen::Vector3d& pose = chain.end().pose;
    const Eigen::Matrix3d covariance = chain.end().covariance +
                                       noise.covariance(chain.end_us() - begin_us) +
                                       kLeastVarianceM2 * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d error = estimation_error(pose, *motion);
    ++errors_.chains;
    errors_.anees += normalised_error_squared(pose, covariance, *motion, 3) / 3.0;
    errors_.nees += error.cwiseAbs2().cwiseQuotient(covariance.diagonal());
    errors_.rmse += error.cwiseAbs2();
    errors_.position_percent += 100.0 * error.head<2>().norm() / std::max(chain.driven_m(), 1.0);
  }

  SegmentErrors errors_;
  bool is_open_ = false;
};

using AllLengths = std::vector<LengthErrors>;

/// The segments of all lengths that begin at one motion, up to a gap or the largest length.
void add_segments(const std::vector<RecordedEstimate>& estimates, std::size_t first,
                  const TrueTrajectory& truth, const TruthNoise& noise, AllLengths& lengths) {
  const std::int64_t begin_us = estimates[first].start_us;
  std::ranges::for_each(lengths, [](LengthErrors& length) { length.open(); });
  MotionChain chain(begin_us);
  MotionChain before = chain;
  for (std::size_t i = first; i < estimates.size() && chain.add(estimates[i]); ++i) {
    bool is_any_open = false;
    for (LengthErrors& length : lengths) {
      if (length.is_open()) {
        length.close_if_long_enough(chain, before, begin_us, truth, noise);
        is_any_open |= length.is_open();
      }
    }
    if (!is_any_open) {
      return;
    }
    before = chain;
  }
}

}  // namespace

std::string to_text(const SegmentLength& length) {
  const bool is_way = length.way_m < kNoLimit;
  const auto number = TextLine().fixed(is_way ? length.way_m : length.time_s, 0);
  return std::string(number.view()) + (is_way ? " m" : " s");
}

std::vector<SegmentErrors> trajectory_segments(const RecordedOdometry& odometry,
                                               const TrueTrajectory& truth, const TruthNoise& noise,
                                               std::int64_t first_window_us) {
  AllLengths lengths(kLengths.begin(), kLengths.end());
  for (const std::size_t first : chain_begins(odometry.estimates, first_window_us)) {
    add_segments(odometry.estimates, first, truth, noise, lengths);
  }
  const TrueTrajectory poses = chained_poses(odometry.steps());
  std::vector<SegmentErrors> result;
  result.reserve(lengths.size());
  for (const LengthErrors& length : lengths) {
    const double time_s = length.length().time_s;
    std::optional<WindowErrors> windows;
    if (time_s < kNoLimit) {
      windows = window_errors(poses, truth, first_window_us, std::llround(1e6 * time_s));
    }
    result.push_back(length.mean(windows));
  }
  return result;
}

const SegmentErrors& after_time(const std::vector<SegmentErrors>& segments, double time_s) {
  const auto found = std::ranges::find_if(
      segments, [&](const auto& errors) { return errors.length.time_s == time_s; });
  if (found == segments.end()) {
    throw std::invalid_argument("no segments of that time");
  }
  return *found;
}

}  // namespace cremed
