// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/state/learned_errors.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "cremed/estimator/scan/squared.hpp"

namespace cremed {
namespace {

/// See prior_after().
constexpr double kMinStdShare = 0.25;
/// The values may be another vehicle's, or the radar was mounted anew: they are then wrong
/// altogether.
constexpr double kSigmasIfWrong = 4.0;

}  // namespace

LearnedErrors unlearned_errors(const OdometryOptions& options, const Pose2& vehicle_from_radar) {
  const double across = squared(std::sin(vehicle_from_radar.yaw_rad));
  return {{0.0, std::hypot(options.mount_yaw_std_rad, across * options.mount_yaw_across_std_rad)},
          {0.0, std::hypot(options.doppler_scale_std, across * options.azimuth_scale_std)}};
}

std::vector<LearnedError> differences(const Eigen::VectorXd& mean,
                                      const Eigen::MatrixXd& covariance,
                                      const std::vector<LearnedError>& unlearned) {
  Eigen::VectorXd weights(mean.size());
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    weights(i) = 1.0 / squared(unlearned[static_cast<std::size_t>(i)].std);
  }
  std::vector<LearnedError> result;
  if (mean.size() < 2 || !weights.allFinite()) {
    return result;
  }
  weights /= weights.sum();
  const auto radars = static_cast<double>(mean.size());
  for (Eigen::Index i = 0; i < mean.size(); ++i) {
    Eigen::VectorXd difference = -weights;
    difference(i) += 1.0;
    const double variance = difference.dot(covariance * difference) * radars / (radars - 1.0);
    result.push_back({difference.dot(mean), std::sqrt(variance)});
  }
  return result;
}

SharedPrior prior_after(const std::vector<std::optional<LearnedError>>& learned,
                        const std::vector<LearnedError>& unlearned, double restart_std) {
  SharedPrior prior;
  for (const LearnedError& error : unlearned) {
    prior.own.push_back({error, false});
  }
  const auto is_taken = [&](std::size_t i) { return learned[i] && unlearned[i].std > 0.0; };
  double weights = 0.0;
  double sum = 0.0;
  int taken = 0;
  for (std::size_t i = 0; i < learned.size(); ++i) {
    if (is_taken(i)) {
      const double weight = 1.0 / squared(unlearned[i].std);
      weights += weight;
      sum += weight * learned[i]->value;
      ++taken;
    }
  }
  if (taken < 2) {
    return prior;
  }
  for (std::size_t i = 0; i < learned.size(); ++i) {
    if (is_taken(i)) {
      const double std = unlearned[i].std;
      const double value = learned[i]->value - sum / weights;
      const double own_std = std::min(std::hypot(learned[i]->std, restart_std), std);
      prior.own[i] = {
          {value, std::max({own_std, kMinStdShare * std, std::abs(value) / kSigmasIfWrong})}, true};
    }
  }
  prior.common_variance = 1.0 / weights;
  return prior;
}

}  // namespace cremed
