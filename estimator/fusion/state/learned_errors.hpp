// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/fusion/state/odometry_options.hpp"
#include "cremed/estimator/scan/pose2.hpp"

namespace cremed {

/// Estimate of a constant error.
struct LearnedError {
  double value = 0.0;
  double std = 0.0;
};

/// Errors of one radar that the odometry filter learned, as priors of the next drive: true minus
/// configured yaw of the mount (rad), and relative excess of its Doppler.
struct LearnedErrors {
  LearnedError mount_yaw_rad;
  LearnedError doppler_scale;
};

/// Priors of the same errors before anything was learned.
LearnedErrors unlearned_errors(const OdometryOptions& options, const Pose2& vehicle_from_radar);

/// Prior of an error for all radars at the start of a drive.
struct SharedPrior {
  struct Own : LearnedError {
    bool is_learned = false;
  };
  /// By radar, independent of each other.
  std::vector<Own> own;
  /// Variance of an additional error common to all radars with learned values.
  double common_variance = 0.0;
};

// An error common to all radars is not observable: it cannot be separated from the slip (mount yaw)
// or the speed (Doppler scale). It is known by the priors alone, which would count again at each
// start. Therefore only differences are kept: each radar's error minus the mean of all, weighted by
// the inverse variances of the unlearned priors.

/// The difference of each radar, from the estimate of all errors; empty for a single radar.
/// Differences are later treated as independent; with N radars their variances are multiplied by N
/// / (N - 1) for this.
std::vector<LearnedError> differences(const Eigen::VectorXd& mean,
                                      const Eigen::MatrixXd& covariance,
                                      const std::vector<LearnedError>& unlearned);

/// Prior of an error from a previous drive (`learned`, by radar, none for some), with the prior
/// N(0, `unlearned`^2) of each radar before that drive.
///
/// The mean of the values taken over is subtracted again. The common error has the variance of this
/// mean under the unlearned priors. A single radar starts from the unlearned prior.
///
/// The standard deviation is the root sum of squares of the learned one and `restart_std` (change
/// by load, temperature and work on the vehicle), at most the unlearned one, but at least a quarter
/// of it and of the value, which may be wrong altogether.
SharedPrior prior_after(const std::vector<std::optional<LearnedError>>& learned,
                        const std::vector<LearnedError>& unlearned, double restart_std);

}  // namespace cremed
