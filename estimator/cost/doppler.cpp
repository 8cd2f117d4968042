// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/cost/doppler.hpp"

#include <cmath>

#include "cremed/estimator/cost/sum_of_logs.hpp"

namespace cremed {
namespace {

/// One Gaussian of the max mixture. Its cost is -log(weight N) up to a constant.
struct Component {
  double variance_m2;
  double weight;
};

/// Sufficient test without a logarithm that the first component is the better one.
bool is_clear(const Component& first, const Component& second, double squared_error_m2) {
  constexpr double kSquaredError = 8.0;
  constexpr double kRatio = 2981.0;  // exp(8)
  return squared_error_m2 <= kSquaredError * first.variance_m2 &&
         first.weight * first.weight * second.variance_m2 >=
             kRatio * second.weight * second.weight * first.variance_m2;
}

/// Whether the cost of the second component is lower.
bool is_second_better(const Component& first, const Component& second, double squared_error_m2) {
  if (is_clear(first, second, squared_error_m2)) {
    return false;
  }
  const double first_scale = first.variance_m2 / (first.weight * first.weight);
  const double second_scale = second.variance_m2 / (second.weight * second.weight);
  return squared_error_m2 / first.variance_m2 - squared_error_m2 / second.variance_m2 >
         std::log(second_scale / first_scale);
}

}  // namespace

double DopplerResidual::cost() const {
  return 0.5 * (error_m * error_m / variance_m2 + std::log(variance_m2 / (weight * weight)));
}

Eigen::Matrix3d doppler_by_motion(const Pose2& vehicle_from_radar) {
  Eigen::Matrix3d result;
  result << 0.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0, vehicle_from_radar.y_m, -vehicle_from_radar.x_m;
  return result;
}

DopplerResidual doppler_residual(const Target& target, double predicted_m, double per_bearing_m,
                                 double dt_s, const DopplerOptions& options, double scale) {
  const double error_m = predicted_m - target.doppler_mps * dt_s;
  const double squared_error_m2 = error_m * error_m;
  const double stamp_m = target.doppler_mps * options.stamp_std_s;
  const double bearing_m = per_bearing_m * target.bearing_std_rad;
  const double common_m2 = stamp_m * stamp_m + bearing_m * bearing_m;
  const auto component = [&](double weight, double doppler_std_mps) {
    const double doppler_m = dt_s * doppler_std_mps;
    return Component{doppler_m * doppler_m + common_m2, weight};
  };
  const Component at_rest = component(1.0 - options.moving_weight, target.doppler_std_mps * scale);
  const Component moving = component(options.moving_weight, options.moving_std_mps);
  const bool is_static =
      options.moving_weight <= 0.0 || !is_second_better(at_rest, moving, squared_error_m2);
  const Component& best = is_static ? at_rest : moving;
  return {error_m, best.variance_m2, best.weight, is_static};
}

// Flattened: of the call for each target only the result's numbers are left.
[[gnu::flatten]] DopplerSums sum_doppler(const TargetSet& targets, const Eigen::Vector3d& change,
                                         const Eigen::Vector3d& systematic, double dt_s,
                                         const DopplerOptions& options, double scale) {
  // Of the terms in z z' and z e.
  double n = 0.0, c = 0.0, s = 0.0, cc = 0.0, cs = 0.0, ss = 0.0, e = 0.0, ce = 0.0, se = 0.0;
  const Eigen::Vector3d predicted = change + systematic;
  const Eigen::Vector3d by_bearing = doppler_by_bearing(change);
  double squared_sigmas = 0.0;
  SumOfLogs scales;
  for (const Target& target : targets) {
    const double cosine = target.cos_bearing;
    const double sine = target.sin_bearing;
    const DopplerResidual residual =
        doppler_residual(target, predicted.x() + predicted.y() * cosine + predicted.z() * sine,
                         by_bearing.y() * cosine + by_bearing.z() * sine, dt_s, options, scale);
    const double weight = 1.0 / residual.variance_m2;
    const double weighted_cosine = weight * cosine;
    const double weighted_sine = weight * sine;
    n += weight;
    c += weighted_cosine;
    s += weighted_sine;
    cc += weighted_cosine * cosine;
    cs += weighted_cosine * sine;
    ss += weighted_sine * sine;
    e += weight * residual.error_m;
    ce += weighted_cosine * residual.error_m;
    se += weighted_sine * residual.error_m;
    squared_sigmas += weight * residual.error_m * residual.error_m;
    scales.add(residual.variance_m2 / (residual.weight * residual.weight));
  }
  DopplerSums sums;
  sums.products << n, c, s, c, cc, cs, s, cs, ss;
  sums.errors << e, ce, se;
  sums.cost = 0.5 * (squared_sigmas + scales.value());
  return sums;
}

}  // namespace cremed
