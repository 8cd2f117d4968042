// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/credibility.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Dense>
#include <spdlog/fmt/fmt.h>

#include "cremed/estimator/scan/degrees.hpp"

namespace cremed {
namespace {

double mean(double sum, std::size_t count) { return sum / divisor(count); }

}  // namespace

Eigen::Vector3d estimation_error(const Eigen::Vector3d& estimate, const Eigen::Vector3d& truth) {
  Eigen::Vector3d error = estimate - truth;
  error.z() = std::remainder(error.z(), 2.0 * std::numbers::pi);
  return error;
}

double normalised_error_squared(const Eigen::Vector3d& estimate, const Eigen::Matrix3d& covariance,
                                const Eigen::Vector3d& truth, int degrees_of_freedom) {
  const Eigen::Vector3d error = estimation_error(estimate, truth);
  if (degrees_of_freedom == 3) {
    return error.dot(covariance.ldlt().solve(error));
  }
  const std::array<Eigen::Index, 2> states{0, 2};
  const Eigen::Vector2d free_error = error(states);
  const Eigen::Matrix2d free_covariance = covariance(states, states);
  return free_error.dot(free_covariance.ldlt().solve(free_error));
}

double divisor(std::size_t count) {
  return count == 0 ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(count);
}

void Credibility::add(const Eigen::Vector3d& estimate, const Eigen::Matrix3d& covariance,
                      const Eigen::Vector3d& truth) {
  const Eigen::Vector3d error = estimation_error(estimate, truth);
  ++count_;
  squared_position_m2_ += error.head<2>().squaredNorm();
  squared_yaw_rad2_ += error.z() * error.z();
  for (int axis = 0; axis < 3; ++axis) {
    if (!is_estimated(axis)) {
      continue;
    }
    const double normalised = error(axis) / std::sqrt(covariance(axis, axis));
    const auto index = static_cast<std::size_t>(axis);
    for (std::size_t k = 0; k < 3; ++k) {
      within_[index][k] += std::abs(normalised) <= static_cast<double>(k + 1) ? 1U : 0U;
    }
  }
  nees_ += normalised_error_squared(estimate, covariance, truth, degrees_of_freedom_) /
           degrees_of_freedom_;
}

double Credibility::rmse_m() const { return std::sqrt(mean(squared_position_m2_, count_)); }

double Credibility::rmse_deg() const {
  return std::sqrt(mean(squared_yaw_rad2_, count_)) * kDegPerRad;
}

double Credibility::anees() const { return mean(nees_, count_); }

double Credibility::coverage(int axis, int sigmas) const {
  if (!is_estimated(axis) || std::isnan(nees_)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return mean(
      static_cast<double>(
          within_.at(static_cast<std::size_t>(axis)).at(static_cast<std::size_t>(sigmas - 1))),
      count_);
}

std::string to_line(const Credibility& credibility) {
  // '>': fmt would else put NaN to the left.
  std::string line = fmt::format("{:7} {:>9.5f} {:>9.5f} {:>9.4f}", credibility.count(),
                                 credibility.rmse_m(), credibility.rmse_deg(), credibility.anees());
  for (int axis = 0; axis < 3; ++axis) {
    for (int sigmas = 1; sigmas <= 3; ++sigmas) {
      line += fmt::format(" {:>6.3f}", credibility.coverage(axis, sigmas));
    }
  }
  return line;
}

}  // namespace cremed
