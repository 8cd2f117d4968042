// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/shared_doppler.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

namespace cremed {

namespace {

/// An error of zero deviation is none: it is held fast.
constexpr double kLeastStd = 1e-9;

double information_of(double deviation) {
  const double held = std::max(deviation, kLeastStd);
  return 1.0 / (held * held);
}

}  // namespace

SharedDoppler::SharedDoppler(const DopplerOptions& options, const SharedErrorOptions& errors,
                             const Pose2& vehicle_from_radar)
    : options_(options), errors_(errors), vehicle_from_radar_(vehicle_from_radar) {
  start(1.0);
}

void SharedDoppler::start(double rolling) {
  shared_.setZero();
  prior_information_ << information_of(rolling * errors_.doppler_offset_std_mps),
      information_of(rolling * errors_.mount_yaw_std_rad),
      information_of(errors_.acceleration_std_mps2),
      information_of(errors_.yaw_acceleration_std_radps2);
}

void SharedDoppler::add(const TargetSet& previous, const TargetSet& current,
                        const Eigen::Vector3d& motion, double dt_s, NormalEquations& equations) {
  Sums sums;
  add_scan(current, motion, dt_s, 1.0, sums);
  if (options_.both_scans) {
    add_scan(previous, motion, dt_s, -1.0, sums);
  }
  const SharedVector pull = prior_information_.cwiseProduct(shared_);
  sums.shared.diagonal() += prior_information_;
  sums.gradient += pull;
  const Eigen::LLT<SharedMatrix> factor(sums.shared);
  const Eigen::Matrix<double, kShared, 3> gain = factor.solve(sums.cross.transpose());
  const SharedVector step = factor.solve(sums.gradient);
  equations.information += sums.motion.information - sums.cross * gain;
  equations.gradient += sums.motion.gradient - sums.cross * step;
  equations.cost += sums.motion.cost + 0.5 * shared_.dot(pull) - 0.5 * sums.gradient.dot(step);
  shared_ -= step;
}

void SharedDoppler::add_scan(const TargetSet& targets, const Eigen::Vector3d& motion, double dt_s,
                             double side, Sums& sums) const {
  const double half_s2 = side * 0.5 * dt_s * dt_s;
  for (const Target& target : targets) {
    const DopplerGeometry geometry(target, motion, vehicle_from_radar_);
    SharedVector shared;
    shared << dt_s, geometry.per_bearing_m, half_s2 * geometry.jacobian.x(),
        half_s2 * geometry.jacobian.z();
    const DopplerResidual doppler =
        doppler_residual(target, geometry, dt_s, options_, 1.0, shared.dot(shared_));
    const double weight = doppler.per_m * doppler.per_m;
    const Eigen::RowVector3d jacobian = weight * geometry.jacobian;
    sums.motion.information.noalias() += jacobian.transpose() * geometry.jacobian;
    sums.motion.gradient.noalias() += doppler.error_m * jacobian.transpose();
    sums.motion.cost += doppler.cost;
    sums.cross.noalias() += jacobian.transpose() * shared.transpose();
    sums.shared.noalias() += (weight * shared) * shared.transpose();
    sums.gradient.noalias() += weight * doppler.error_m * shared;
  }
}

}  // namespace cremed
