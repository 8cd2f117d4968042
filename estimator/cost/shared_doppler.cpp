// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/cost/shared_doppler.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "cremed/estimator/cost/driving_share.hpp"
#include "cremed/estimator/scan/squared.hpp"

namespace cremed {

namespace {

/// Replaces a standard deviation of 0, in m/s, rad, m/s^2 or rad/s^2. The error is then fixed at 0,
/// and its information stays finite.
constexpr double kMinStd = 1e-9;

double information_of(double deviation) { return 1.0 / squared(std::max(deviation, kMinStd)); }

/// Turns the translation of a motion by minus half its yaw, into the frame half way. `by_motion`:
/// the derivative.
void turn_back(Eigen::Vector3d& motion, Eigen::Matrix3d& by_motion) {
  const Eigen::Matrix2d back = Eigen::Rotation2Dd(-0.5 * motion.z()).toRotationMatrix();
  const Eigen::Vector2d turned = back * motion.head<2>();
  by_motion.topLeftCorner<2, 2>() = back;
  by_motion.topRightCorner<2, 1>() << 0.5 * turned.y(), -0.5 * turned.x();
  motion.head<2>() = turned;
}

}  // namespace

SharedDoppler::SharedDoppler(int degrees_of_freedom, const DopplerOptions& doppler,
                             const SharedErrorOptions& errors, const Pose2& vehicle_from_radar)
    : degrees_of_freedom_(degrees_of_freedom),
      options_(doppler),
      errors_(errors),
      vehicle_from_radar_(vehicle_from_radar) {}

SharedErrors SharedDoppler::prior_information(double driving) const {
  const double sideways_std_mps2 = degrees_of_freedom_ == 3 ? errors_.acceleration_std_mps2 : 0.0;
  SharedErrors information;
  information << information_of(driving * errors_.doppler_offset_std_mps),
      information_of(driving * errors_.mount_yaw_std_rad),
      information_of(errors_.acceleration_std_mps2), information_of(sideways_std_mps2),
      information_of(errors_.yaw_acceleration_std_radps2);
  return information;
}

NormalEquations SharedDoppler::linearise(const TargetSet& previous, const TargetSet& current,
                                         double dt_s, const Unknowns& at) const {
  Unknowns half_way = at;
  Eigen::Matrix3d by_motion = Eigen::Matrix3d::Identity();
  if (degrees_of_freedom_ == 3) {
    turn_back(half_way.motion, by_motion);
  }
  Sums sums;
  add_scan(current, half_way, dt_s, 1.0, sums);
  if (options_.both_scans) {
    add_scan(previous, half_way, dt_s, -1.0, sums);
  }
  const Eigen::Matrix3d information = sums.information.topLeftCorner<3, 3>();
  const Eigen::Matrix<double, 3, kShared> cross = sums.information.topRightCorner<3, kShared>();
  const double noise_m = 1.0 / std::sqrt(information(0, 0));
  const SharedErrors prior =
      prior_information(driving_share(speed_beyond_noise_mps(at.motion, noise_m, dt_s)));
  const SharedErrors pull = prior.cwiseProduct(at.shared);
  SharedMatrix shared = sums.information.bottomRightCorner<kShared, kShared>();
  shared.diagonal() += prior;
  const SharedErrors gradient = sums.gradient.tail<kShared>() + pull;
  const Eigen::LLT<SharedMatrix> factor(shared);
  const Eigen::Matrix<double, kShared, 3> gain = factor.solve(cross.transpose());
  const SharedErrors step = factor.solve(gradient);
  return {by_motion.transpose() * (information - cross * gain) * by_motion,
          by_motion.transpose() * (sums.gradient.head<3>() - cross * step),
          sums.cost + 0.5 * at.shared.dot(pull) - 0.5 * gradient.dot(step), at.shared - step};
}

void SharedDoppler::add_scan(const TargetSet& targets, const Unknowns& half_way, double dt_s,
                             double side, Sums& sums) const {
  const Eigen::Matrix3d by_motion = doppler_by_motion(vehicle_from_radar_);
  const Eigen::Vector3d change = by_motion.transpose() * half_way.motion;
  Eigen::Matrix<double, 3 + kShared, 3> by;  // Derivatives of the change, as factors of z.
  by << by_motion, dt_s, 0.0, 0.0, doppler_by_bearing(change).transpose(),
      side * 0.5 * dt_s * dt_s * by_motion;
  const Eigen::Vector3d systematic = by.bottomRows<kShared>().transpose() * half_way.shared;
  const DopplerSums scan = sum_doppler(targets, change, systematic, dt_s, options_, 1.0);
  sums.information.noalias() += by * scan.products * by.transpose();
  sums.gradient.noalias() += by * scan.errors;
  sums.cost += scan.cost;
}

}  // namespace cremed
