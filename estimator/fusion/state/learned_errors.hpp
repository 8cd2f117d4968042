// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/fusion/state/odometry_options.hpp"
#include "cremed/estimator/scan/pose2.hpp"

namespace cremed {

/// A constant error, as far as it is known.
struct LearnedError {
  double value = 0.0;
  double std = 0.0;
};

/// What the odometry filter learned of one radar that the next drive may begin with: true yaw of
/// the mount less the configured one (rad), and by which part its Doppler is too great.
struct LearnedErrors {
  LearnedError mount_yaw_rad;
  LearnedError doppler_scale;
};

/// What is known of the same before anything was learned.
LearnedErrors unlearned_errors(const OdometryOptions& options, const Pose2& vehicle_from_radar);

/// An error of all radars at the start of a drive.
struct SharedPrior {
  struct Own : LearnedError {
    bool is_learned = false;
  };
  /// By radar; each independent of the others.
  std::vector<Own> own;
  /// Variance of what those that are learned err by in common, besides.
  double common_variance = 0.0;
};

// What all radars err by alike cannot be told from the slip (mount yaw) or the speed (Doppler
// scale): a drive knows it by their priors alone, and would count these once more at each start. So
// only differences are kept: each radar's error less the mean of all, weighted by the inverse
// variances of what was unlearned.

/// That of each of several radars, of what is known of their errors; none of a lone radar, which
/// has no difference. Errors of such differences are taken for independent: with N radars their
/// variances are therefore N / (N - 1) of what they are.
std::vector<LearnedError> differences(const Eigen::VectorXd& mean,
                                      const Eigen::MatrixXd& covariance,
                                      const std::vector<LearnedError>& unlearned);

/// What a drive before (`learned`, by radar; nothing of some) says of an error that was N(0,
/// unlearned) of each radar before it.
///
/// The mean of those that are taken over is taken off once more, and what they err by in common has
/// the variance that this mean has unlearned. One radar begins as if nothing was learned.
///
/// A standard deviation taken over is that learned and `restart_std` (what loads, temperature and
/// work on the vehicle change meanwhile) in squares; at least a quarter of the unlearned, so that
/// what is wrong by five of them is as likely as 1.25 unlearned, and is soon unlearned; at most the
/// unlearned.
SharedPrior prior_after(const std::vector<std::optional<LearnedError>>& learned,
                        const std::vector<LearnedError>& unlearned, double restart_std);

}  // namespace cremed
