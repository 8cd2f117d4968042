// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/trajectory_segments.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include <Eigen/Cholesky>

#include "cremed/estimator/scan/stamps.hpp"
#include "daemon/output/text_line.hpp"
#include "tools/eval/credibility.hpp"
#include "tools/eval/drive/motion_chain.hpp"

namespace cremed {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

constexpr std::array kLengths{SegmentLength{10.0, kNoLimit},  SegmentLength{50.0, kNoLimit},
                              SegmentLength{100.0, kNoLimit}, SegmentLength{kNoLimit, 1.0},
                              SegmentLength{kNoLimit, 5.0},   SegmentLength{kNoLimit, 10.0},
                              SegmentLength{kNoLimit, 30.0}};

/// Neighbouring segments are nearly equal; every fifth begin is enough.
constexpr std::size_t kMotionsPerSegment = 5;

/// In 2 degrees of freedom y has no variance; a micrometre makes the matrix invertible.
constexpr double kLeastVariance = 1e-12;

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

std::vector<std::size_t> segment_begins(const std::vector<RecordedEstimate>& estimates) {
  const std::vector<std::size_t> all = begins(estimates);
  const std::size_t every = all.size() == estimates.size() ? kMotionsPerSegment : 1;
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < all.size(); i += every) {
    result.push_back(all[i]);
  }
  return result;
}

class LengthErrors {
 public:
  explicit LengthErrors(const SegmentLength& length) { errors_.length = length; }

  /// Whether the growing segment is shorter.
  [[nodiscard]] bool is_open() const { return is_open_; }
  void open() { is_open_ = true; }

  void close_if_long_enough(const MotionChain& chain, std::int64_t begin_us,
                            const TrueTrajectory& truth, const TruthNoise& noise) {
    if (chain.driven_m() < errors_.length.way_m &&
        seconds_between(begin_us, chain.end_us()) < errors_.length.time_s) {
      return;
    }
    is_open_ = false;
    if (const auto motion = truth.motion(begin_us, chain.end_us())) {
      add(chain.end().pose, chain.end().covariance + noise.covariance(chain.end_us() - begin_us),
          *motion, chain.driven_m());
    }
  }

  [[nodiscard]] SegmentErrors mean() const {
    SegmentErrors mean = errors_;
    const double count = mean.segments == 0 ? std::numeric_limits<double>::quiet_NaN()
                                            : static_cast<double>(mean.segments);
    mean.anees /= count;
    mean.nees /= count;
    mean.rmse = (mean.rmse / count).cwiseSqrt();
    mean.position_percent /= count;
    return mean;
  }

 private:
  void add(const Eigen::Vector3d& pose, const Eigen::Matrix3d& covariance,
           const Eigen::Vector3d& truth, double driven_m) {
    const Eigen::Matrix3d regular = covariance + kLeastVariance * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d error = estimation_error(pose, truth);
    ++errors_.segments;
    errors_.anees += normalised_error_squared(pose, regular, truth, 3) / 3.0;
    errors_.nees += error.cwiseAbs2().cwiseQuotient(regular.diagonal());
    errors_.rmse += error.cwiseAbs2();
    errors_.position_percent += 100.0 * error.head<2>().norm() / std::max(driven_m, 1.0);
  }

  SegmentErrors errors_{{}, 0, 0.0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.0};
  bool is_open_ = false;
};

using AllLengths = std::vector<LengthErrors>;

/// The segments of all lengths that begin at one motion, up to a gap or the largest length.
void add_segments(const std::vector<RecordedEstimate>& estimates, std::size_t first,
                  const TrueTrajectory& truth, const TruthNoise& noise, AllLengths& lengths) {
  const std::int64_t begin_us = estimates[first].start_us;
  std::for_each(lengths.begin(), lengths.end(), [](LengthErrors& length) { length.open(); });
  MotionChain chain(begin_us);
  for (std::size_t i = first; i < estimates.size() && chain.add(estimates[i]); ++i) {
    bool is_any_open = false;
    for (LengthErrors& length : lengths) {
      if (length.is_open()) {
        length.close_if_long_enough(chain, begin_us, truth, noise);
        is_any_open |= length.is_open();
      }
    }
    if (!is_any_open) {
      return;
    }
  }
}

}  // namespace

std::string to_text(const SegmentLength& length) {
  const bool is_way = length.way_m < kNoLimit;
  const auto number = TextLine().fixed(is_way ? length.way_m : length.time_s, 0);
  return std::string(number.view()) + (is_way ? " m" : " s");
}

std::vector<SegmentErrors> trajectory_segments(const std::vector<RecordedEstimate>& estimates,
                                               const TrueTrajectory& truth,
                                               const TruthNoise& noise) {
  AllLengths lengths(kLengths.begin(), kLengths.end());
  for (const std::size_t first : segment_begins(estimates)) {
    add_segments(estimates, first, truth, noise, lengths);
  }
  std::vector<SegmentErrors> result;
  result.reserve(lengths.size());
  for (const LengthErrors& length : lengths) {
    result.push_back(length.mean());
  }
  return result;
}

}  // namespace cremed
