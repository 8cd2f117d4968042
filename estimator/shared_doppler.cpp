// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/shared_doppler.hpp"

#include <Eigen/Cholesky>

namespace cremed {

SharedDoppler::SharedDoppler(const DopplerOptions& options, const SharedErrorOptions& errors,
                             const Pose2& vehicle_from_radar)
    : options_(options), both_(errors.both_scans), vehicle_from_radar_(vehicle_from_radar) {
  const auto information = [](double deviation) {
    return 1.0 / std::max(deviation * deviation, 1e-18);
  };
  information_ << information(errors.doppler_offset_std_mps), information(errors.mount_yaw_std_rad),
      information(errors.acceleration_std_mps2), information(errors.yaw_acceleration_std_radps2);
  if (!errors.target_stamp) options_.stamp_std_s = 0;
}

void SharedDoppler::add(const TargetSet& previous, const TargetSet& current,
                        const Eigen::Vector3d& motion, double dt_s, NormalEquations& equations) {
  Sums sums;
  add_scan(current, motion, dt_s, 1.0, sums);
  if (both_) add_scan(previous, motion, dt_s, -1.0, sums);
  sums.shared.diagonal() += information_;
  sums.gradient += information_.cwiseProduct(shared_);
  const Eigen::LLT<Eigen::Matrix<double, kShared, kShared>> factor(sums.shared);
  const Eigen::Matrix<double, kShared, 3> gain = factor.solve(sums.cross.transpose());
  const SharedVector step = factor.solve(sums.gradient);
  equations.information += sums.motion.information - sums.cross * gain;
  equations.gradient += sums.motion.gradient - sums.cross * step;
  equations.cost += sums.motion.cost + 0.5 * shared_.dot(information_.cwiseProduct(shared_)) -
                    0.5 * sums.gradient.dot(step);
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
