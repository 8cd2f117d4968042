// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/cost/exclusive_cost.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cremed/estimator/cost/consider_parameters.hpp"

namespace cremed {

ExclusiveCost::ExclusiveCost(int degrees_of_freedom, const DopplerOptions& doppler,
                             const SharedErrorOptions& errors, const Pose2& vehicle_from_radar)
    : degrees_of_freedom_(degrees_of_freedom),
      has_doppler_(doppler.enabled),
      errors_(errors),
      shared_doppler_(degrees_of_freedom, doppler, errors, vehicle_from_radar) {}

void ExclusiveCost::set_scans(const TargetSet& previous, const TargetSet& current, double dt_s,
                              const OutlierRay& ray) {
  previous_ = &previous;
  current_ = &current;
  dt_s_ = dt_s;
  likelihood_.assign(previous, current, ray);
}

void ExclusiveCost::start() {
  settle_ = false;
  moved_sigmas_ = std::numeric_limits<double>::infinity();
  positions_ = doppler_ = NormalEquations();
}

void ExclusiveCost::update_list(const Eigen::Vector3d& motion) {
  const Eigen::Vector3d step = motion - motion_;
  const double squared_step = step.dot((positions_.information + doppler_.information) * step);
  // `squared_step` sums over all targets; the distance is the root mean square over the matched
  // ones.
  moved_sigmas_ += std::sqrt(squared_step / std::max(likelihood_.matched(), 1.0));
  motion_ = motion;
  if (!(moved_sigmas_ <= 0.5 * ExclusiveLikelihood::kListMarginSigmas)) {
    is_complete_ = likelihood_.list_pairs(*previous_, *current_, motion);
    moved_sigmas_ = 0.0;
  }
}

NormalEquations ExclusiveCost::linearise(const Unknowns& at) {
  update_list(at.motion);
  if (!is_complete_) {
    return {};
  }
  positions_ = likelihood_.linearise(*previous_, *current_, at.motion, settle_);
  if (has_doppler_) {
    doppler_ = shared_doppler_.linearise(*previous_, *current_, dt_s_, at);
  }
  return {positions_.information + doppler_.information, positions_.gradient + doppler_.gradient,
          positions_.cost + doppler_.cost, doppler_.shared};
}

std::optional<Estimate> ExclusiveCost::estimate(const Unknowns& at,
                                                const NormalEquations& equations) {
  const auto complete = invert_information(equations.information, degrees_of_freedom_);
  if (!complete) {
    return std::nullopt;
  }
  const Eigen::Vector3d sigma = complete->diagonal().cwiseSqrt();
  missing_information_ = likelihood_.missing_information(sigma);
  auto covariance =
      invert_information(equations.information - missing_information_, degrees_of_freedom_);
  if (!covariance) {
    return std::nullopt;
  }
  const Eigen::Vector3d motion = at.motion - *covariance * equations.gradient;
  add_consider_covariance(errors_, motion, dt_s_, has_doppler_, degrees_of_freedom_, *covariance);
  return Estimate{motion, *covariance};
}

double ExclusiveCost::doppler_nis() const {
  const auto by_position = invert_information(positions_.information, degrees_of_freedom_);
  const auto by_doppler = invert_information(doppler_.information, degrees_of_freedom_);
  if (!by_position || !by_doppler) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const Eigen::Vector3d& g = doppler_.gradient;
  return g.dot((*by_doppler + *by_position) * g) / degrees_of_freedom_;
}

YawByPositions ExclusiveCost::by_positions(const Unknowns& at) const {
  const auto covariance = invert_information(positions_.information - missing_information_, 3);
  if (!covariance) {
    return {};
  }
  const Eigen::Vector3d step = -*covariance * positions_.gradient;
  return {at.motion.z() + step.z(), (*covariance)(2, 2)};
}

}  // namespace cremed
