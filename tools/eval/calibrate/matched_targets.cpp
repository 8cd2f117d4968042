// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/calibrate/matched_targets.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

namespace cremed {
namespace {

struct PolarTarget {
  double range_m = 0.0;
  double azimuth_rad = 0.0;
  double range_variance_m2 = 0.0;
  double azimuth_variance_rad2 = 0.0;
};

PolarTarget polar(const Target& target, const Pose2& pose, const AssumedFactors& assumed) {
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  const double x_m = pose.x_m + c * target.x_m - s * target.y_m;
  const double y_m = pose.y_m + s * target.x_m + c * target.y_m;
  const Symmetric2& covariance = target.covariance_m2;
  const double cb = target.cos_bearing;
  const double sb = target.sin_bearing;
  const double range_variance_m2 =
      cb * cb * covariance.xx + 2.0 * cb * sb * covariance.xy + sb * sb * covariance.yy;
  const double azimuth_std_rad = assumed.azimuth * target.bearing_std_rad;
  return {std::hypot(x_m, y_m), std::atan2(y_m, x_m),
          assumed.range * assumed.range * range_variance_m2, azimuth_std_rad * azimuth_std_rad};
}

struct PolarError {
  double range = 0.0;
  double azimuth = 0.0;
  double azimuth_std_rad = 0.0;
};

/// None outside of the gate, or of what is not finite.
std::optional<PolarError> error_of(const PolarTarget& previous, const PolarTarget& current) {
  const double way_m = current.range_m - previous.range_m;
  const double range_variance_m2 = previous.range_variance_m2 + current.range_variance_m2;
  // Most pairs end here, without a root.
  if (!(way_m * way_m < kErrorGate * kErrorGate * range_variance_m2)) {
    return std::nullopt;
  }
  const double turn_rad =
      std::remainder(current.azimuth_rad - previous.azimuth_rad, 2.0 * std::numbers::pi);
  const double azimuth_std_rad =
      std::sqrt(previous.azimuth_variance_rad2 + current.azimuth_variance_rad2);
  if (!(std::abs(turn_rad) < kErrorGate * azimuth_std_rad)) {
    return std::nullopt;
  }
  return PolarError{way_m / std::sqrt(range_variance_m2), turn_rad / azimuth_std_rad,
                    azimuth_std_rad};
}

/// The partners within the gate of one target.
struct Candidates {
  int count = 0;
  std::size_t partner = 0;
  PolarError error;
};

std::vector<PolarTarget> all_polar(const std::vector<Target>& targets, const Pose2& pose,
                                   const AssumedFactors& assumed) {
  std::vector<PolarTarget> result;
  result.reserve(targets.size());
  for (const Target& target : targets) {
    result.push_back(polar(target, pose, assumed));
  }
  return result;
}

}  // namespace

void add_match_errors(const RecordedScan& previous, const RecordedScan& current,
                      const Pose2& motion, const AssumedFactors& assumed, MatchErrors& errors) {
  const auto before = all_polar(previous.targets, {}, assumed);
  const auto after = all_polar(current.targets, motion, assumed);
  std::vector<int> suitors(before.size());
  std::vector<Candidates> found(after.size());
  for (std::size_t i = 0; i < after.size(); ++i) {
    for (std::size_t j = 0; j < before.size(); ++j) {
      if (const auto error = error_of(before[j], after[i])) {
        ++suitors[j];
        found[i] = {found[i].count + 1, j, *error};
      }
    }
  }
  for (const Candidates& candidates : found) {
    if (candidates.count == 1 && suitors[candidates.partner] == 1) {
      errors.range.push_back({current.stamp_us, candidates.error.range, 0.0});
      errors.azimuth.push_back({current.stamp_us, candidates.error.azimuth, 0.0});
      errors.azimuth_std_rad.push_back(candidates.error.azimuth_std_rad);
    }
  }
}

}  // namespace cremed
