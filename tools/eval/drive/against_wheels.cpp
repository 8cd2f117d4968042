// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/against_wheels.hpp"

#include <algorithm>
#include <cmath>

#include "cremed/estimator/scan/stamps.hpp"
#include "tools/eval/credibility.hpp"

namespace cremed {
namespace {

constexpr std::int64_t kStepUs = 10'000;

/// Errors of one motion on one axis, against the wheels.
struct AxisErrors {
  double estimate = 0.0;
  double truth = 0.0;
  double variance = 0.0;  ///< Of the estimate.
  double wheels_variance = 0.0;
};

void add(AxisAgainstWheels& sums, const AxisErrors& errors, double dt_s) {
  const double e = errors.estimate;
  const double t = errors.truth;
  ++sums.count;
  sums.nees += e * e / (errors.variance + errors.wheels_variance);
  sums.nees_estimate += e * e / errors.variance;
  sums.nees_truth += t * t / errors.variance;
  sums.nees_cross -= 2.0 * e * t / errors.variance;
  sums.rms_estimate_per_s += e * e / (dt_s * dt_s);
  sums.rms_truth_per_s += t * t / (dt_s * dt_s);
  sums.rms_both_per_s += (e - t) * (e - t) / (dt_s * dt_s);
}

void turn_sums_into_means(AxisAgainstWheels& sums) {
  const double count = divisor(sums.count);
  for (double* const sum : {&sums.nees, &sums.nees_estimate, &sums.nees_truth, &sums.nees_cross}) {
    *sum /= count;
  }
  for (double* const sum :
       {&sums.rms_estimate_per_s, &sums.rms_truth_per_s, &sums.rms_both_per_s}) {
    *sum = std::sqrt(*sum / count);
  }
}

/// Sums of truth's errors against the wheels.
struct SquareSums {
  std::size_t count = 0;
  Eigen::Vector3d errors = Eigen::Vector3d::Zero();
  double ways_m2 = 0.0;
  double way_by_y_m2 = 0.0;

  void add(const Eigen::Vector3d& wheels, const Eigen::Vector3d& error) {
    ++count;
    errors += error.cwiseAbs2();
    ways_m2 += wheels.x() * wheels.x();
    way_by_y_m2 += wheels.x() * error.y();
  }

  /// The best fitting direction is way_by_y / ways; undefined at standstill.
  [[nodiscard]] TruthAgainstWheels means(double interval_s) const {
    const double explained_m2 = ways_m2 > 0.0 ? way_by_y_m2 * way_by_y_m2 / ways_m2 : 0.0;
    const double n = divisor(count);
    return {interval_s, count, std::sqrt(errors.x() / n),
            std::sqrt(std::max(errors.y() - explained_m2, 0.0) / n), std::sqrt(errors.z() / n)};
  }
};

void add(MotionsAgainstWheels& sums, const RecordedEstimate& estimate, const Eigen::Vector3d& truth,
         const Eigen::Vector3d& wheels, const WheelStd& std) {
  const double dt_s = seconds_between(estimate.start_us, estimate.end_us);
  const Eigen::Vector3d e = estimation_error(estimate.motion, wheels);
  const Eigen::Vector3d t = estimation_error(truth, wheels);
  const Eigen::Matrix3d& c = estimate.covariance;
  add(sums.x, {e.x(), t.x(), c(0, 0), std::pow(std.speed_mps * dt_s, 2)}, dt_s);
  add(sums.yaw, {e.z(), t.z(), c(2, 2), std::pow(std.yaw_rate_radps * dt_s, 2)}, dt_s);
}

}  // namespace

MotionsAgainstWheels against_wheels(const std::vector<RecordedEstimate>& estimates,
                                    const TrueTrajectory& truth, const WheelReference& wheels) {
  MotionsAgainstWheels result;
  for (const RecordedEstimate& estimate : estimates) {
    const auto true_motion = truth.motion(estimate.start_us, estimate.end_us);
    const auto wheel_motion = wheels.motion(estimate.start_us, estimate.end_us);
    if (true_motion && wheel_motion && estimate.end_us > estimate.start_us) {
      add(result, estimate, *true_motion, *wheel_motion, wheels.std());
    }
  }
  turn_sums_into_means(result.x);
  turn_sums_into_means(result.yaw);
  return result;
}

TruthAgainstWheels truth_against_wheels(const TrueTrajectory& truth, const WheelReference& wheels,
                                        std::int64_t interval_us) {
  SquareSums sums;
  if (!truth.utime_us().empty() && !wheels.utime_us().empty()) {
    const std::int64_t end_us = std::min(truth.utime_us().back(), wheels.utime_us().back());
    for (std::int64_t start_us = std::max(truth.utime_us().front(), wheels.utime_us().front());
         start_us + interval_us <= end_us; start_us += kStepUs) {
      const auto true_motion = truth.motion(start_us, start_us + interval_us);
      const auto wheel_motion = wheels.motion(start_us, start_us + interval_us);
      if (true_motion && wheel_motion) {
        sums.add(*wheel_motion, estimation_error(*true_motion, *wheel_motion));
      }
    }
  }
  return sums.means(seconds_between(0, interval_us));
}

TwistAgainstWheels against_wheels(const std::vector<Odometry>& states,
                                  const WheelReference& wheels) {
  const double speed_variance = std::pow(wheels.std().speed_mps, 2);
  const double yaw_rate_variance = std::pow(wheels.std().yaw_rate_radps, 2);
  TwistAgainstWheels result;
  for (const Odometry& state : states) {
    if (const auto rates = wheels.rates(state.utime_us)) {
      const double speed_2 = std::pow(state.twist.x() - rates->x(), 2);
      const double yaw_rate_2 = std::pow(state.twist.z() - rates->y(), 2);
      ++result.count;
      result.nees_speed += speed_2 / (state.twist_covariance(0, 0) + speed_variance);
      result.nees_yaw_rate += yaw_rate_2 / (state.twist_covariance(2, 2) + yaw_rate_variance);
      result.rms_speed_mps += speed_2;
      result.rms_yaw_rate_radps += yaw_rate_2;
    }
  }
  const double count = divisor(result.count);
  result.nees_speed /= count;
  result.nees_yaw_rate /= count;
  result.rms_speed_mps = std::sqrt(result.rms_speed_mps / count);
  result.rms_yaw_rate_radps = std::sqrt(result.rms_yaw_rate_radps / count);
  return result;
}

}  // namespace cremed
