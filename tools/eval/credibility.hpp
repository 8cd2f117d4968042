// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include <Eigen/Core>

namespace cremed {

/// estimate - truth, its yaw wrapped to (-pi, pi].
Eigen::Vector3d estimation_error(const Eigen::Vector3d& estimate, const Eigen::Vector3d& truth);

/// e' C^-1 e over the estimated states of e = estimation_error(): chi-square with as many degrees
/// of freedom if the covariance is credible.
double normalised_error_squared(const Eigen::Vector3d& estimate, const Eigen::Matrix3d& covariance,
                                const Eigen::Vector3d& truth, int degrees_of_freedom);

/// What a sum is divided by for its mean: NaN for none.
double divisor(std::size_t count);

/// Agreement of estimates and their covariances with truth. Order of states: (x_m, y_m, yaw_rad).
/// In two degrees of freedom y is estimated as 0 and excluded from the ANEES, but its error counts
/// in the RMSE. Where a covariance is unknown (NaN), so are ANEES and coverage.
class Credibility {
 public:
  explicit Credibility(int degrees_of_freedom) : degrees_of_freedom_(degrees_of_freedom) {}

  /// One estimate; the yaw error is wrapped to (-pi, pi].
  void add(const Eigen::Vector3d& estimate, const Eigen::Matrix3d& covariance,
           const Eigen::Vector3d& truth);

  [[nodiscard]] int degrees_of_freedom() const { return degrees_of_freedom_; }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] double rmse_m() const;
  [[nodiscard]] double rmse_deg() const;
  /// Average normalised estimation error squared, per degree of freedom: 1 if credible.
  [[nodiscard]] double anees() const;
  /// Share of errors within `sigmas` (1, 2, 3) standard deviations of `axis` (0 x, 1 y, 2 yaw);
  /// NaN for an axis that is not estimated, or unknown. Gaussian: 0.683, 0.954, 0.997.
  [[nodiscard]] double coverage(int axis, int sigmas) const;

 private:
  [[nodiscard]] bool is_estimated(int axis) const { return degrees_of_freedom_ == 3 || axis != 1; }

  int degrees_of_freedom_;
  std::size_t count_ = 0;
  double squared_position_m2_ = 0.0;
  double squared_yaw_rad2_ = 0.0;
  double nees_ = 0.0;
  std::array<std::array<std::size_t, 3>, 3> within_{};
};

/// "n rmse_m rmse_deg anees x_1s x_2s x_3s y_1s ... yaw_3s", in columns, without line end.
std::string to_line(const Credibility& credibility);

/// Names of the columns of to_line.
inline constexpr const char* kCredibilityColumns =
    "      n    rmse_m  rmse_deg     anees   x_1s   x_2s   x_3s   y_1s   y_2s   y_3s yaw_1s yaw_2s "
    "yaw_3s";

}  // namespace cremed
