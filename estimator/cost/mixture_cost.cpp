// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/cost/mixture_cost.hpp"

#include "cremed/estimator/cost/doppler.hpp"
#include "cremed/estimator/scan/rotation.hpp"

namespace cremed {

MixtureCost::MixtureCost(int degrees_of_freedom, const DopplerOptions& doppler,
                         const Pose2& vehicle_from_radar)
    : degrees_of_freedom_(degrees_of_freedom),
      doppler_(doppler),
      vehicle_from_radar_(vehicle_from_radar) {}

void MixtureCost::set_current(const TargetSet& current, double dt_s) {
  current_ = &current;
  dt_s_ = dt_s;
  evaluations_ = 0;
}

void MixtureCost::set_scales(double positions, double doppler) {
  scale_ = positions;
  doppler_scale_ = doppler;
}

NormalEquations MixtureCost::linearise(const Unknowns& at) {
  NormalEquations equations;
  add_positions(at.motion, equations);
  if (doppler_.enabled) {
    add_doppler(at.motion, equations);
  }
  return equations;
}

void MixtureCost::add_positions(const Eigen::Vector3d& motion, NormalEquations& equations) {
  const std::size_t size = current_->size();
  const Rotation rotation(motion.z());
  for (std::size_t i = 0; i < size; ++i) {
    const Target& target = (*current_)[i];
    const Eigen::Vector2d lever_m = rotation * Eigen::Vector2d(target.x_m, target.y_m);
    const MixtureResidual residual = mixture_.evaluate(
        lever_m + motion.head<2>(), rotation * (scale_ * scale_ * target.covariance_m2));
    const Eigen::Matrix<double, 3, 2>& jacobian = residual.jacobian;
    equations.add_point({jacobian.col(0).squaredNorm(), jacobian.col(0).dot(jacobian.col(1)),
                         jacobian.col(1).squaredNorm()},
                        jacobian.transpose() * residual.residual, lever_m);
    equations.cost += residual.cost;
  }
  evaluations_ += static_cast<std::int64_t>(size * mixture_.size());
}

void MixtureCost::add_doppler(const Eigen::Vector3d& motion, NormalEquations& equations) const {
  const Eigen::Matrix3d by_motion = doppler_by_motion(vehicle_from_radar_);
  const DopplerSums sums = sum_doppler(*current_, by_motion.transpose() * motion,
                                       Eigen::Vector3d::Zero(), dt_s_, doppler_, doppler_scale_);
  equations.information.noalias() += by_motion * sums.products * by_motion.transpose();
  equations.gradient.noalias() += by_motion * sums.errors;
  equations.cost += sums.cost;
}

std::optional<Estimate> MixtureCost::estimate(const Unknowns& at,
                                              const NormalEquations& equations) const {
  const auto covariance = invert_information(equations.information, degrees_of_freedom_);
  return covariance ? std::optional(Estimate{at.motion, *covariance}) : std::nullopt;
}

}  // namespace cremed
