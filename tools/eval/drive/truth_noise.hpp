// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace cremed {

/// Standard deviation of the reference's own error in the relative pose of two of its stamps.
struct RelativePoseStd {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
  double interval_s = 0.0;  ///< Between the stamps it was found for.
};

/// The true poses' own noise, which is no error of an estimate that is compared with them. Errors
/// of poses that were matched to a map vary slowly: what they do to a relative pose grows with the
/// time between its stamps until it is that of two independent poses. So it may be given for more
/// than one interval; between them it is interpolated linearly, beyond them it stays.
class TruthNoise {
 public:
  TruthNoise() = default;  ///< None.
  explicit TruthNoise(std::vector<RelativePoseStd> stds);

  [[nodiscard]] bool is_zero() const { return stds_.empty(); }
  [[nodiscard]] const std::vector<RelativePoseStd>& stds() const { return stds_; }
  /// To add to the covariance (x_m, y_m, yaw_rad) of a motion over that time.
  [[nodiscard]] Eigen::Matrix3d covariance(std::int64_t interval_us) const;
  /// For the header of a table, with what was done: empty if there is none.
  [[nodiscard]] std::string note() const;

 private:
  std::vector<RelativePoseStd> stds_;  ///< In order of their intervals.
};

}  // namespace cremed
