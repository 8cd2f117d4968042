// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace cremed {

/// Standard deviation of the reference's error in the relative pose of two of its stamps.
struct RelativePoseStd {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
  double interval_s = 0.0;  ///< Time between the stamps.
};

/// Noise of the true poses, which is not an error of the estimate. Errors of poses matched to a map
/// vary slowly: their effect on a relative pose grows with the interval until the two poses are
/// independent. It may therefore be given for several intervals, with linear interpolation between
/// and constant values beyond.
class TruthNoise {
 public:
  TruthNoise() = default;  ///< None.
  explicit TruthNoise(std::vector<RelativePoseStd> stds);

  [[nodiscard]] const std::vector<RelativePoseStd>& stds() const { return stds_; }
  /// Covariance to add to that of a motion (x_m, y_m, yaw_rad) over that time.
  [[nodiscard]] Eigen::Matrix3d covariance(std::int64_t interval_us) const;
  /// Text for the header of a table: empty if there is none.
  [[nodiscard]] std::string note() const;

 private:
  std::vector<RelativePoseStd> stds_;  ///< In order of their intervals.
};

}  // namespace cremed
