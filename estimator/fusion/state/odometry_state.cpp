// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/state/odometry_state.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "cremed/estimator/cost/driving_share.hpp"
#include "cremed/estimator/fusion/state/pose_chain.hpp"
#include "cremed/estimator/motion/vehicle_limits.hpp"
#include "cremed/estimator/scan/gate.hpp"
#include "cremed/estimator/scan/squared.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

using namespace state_layout;

/// If a share q of the targets near the fit rests and the others have V over ground, the speed is
/// off by (1 - q) V, and residuals have the variance q (1 - q) V^2 besides the noise. With a fifth
/// at rest that is twice the square root of the excess. With an ARS408's noise it is 0.02 (m/s)^2
/// in a jam at 0.4 m/s, and up to 0.006 where 1094 creeps.
constexpr double kShiftPerExcess = 2.0;
constexpr double kExcessTimeS = 0.3;
/// An ARS408 flags faster cars as moving, and at a higher speed errors of azimuth widen residuals.
constexpr double kMaxMixedMps = 3.0;

/// Least slip of a skid, in standard deviations of the slip of usual driving.
constexpr double kLeastSkid = 3.0;
/// A slip that stays is no skid. It ends so many kSkidS after the last change of the slip, if that
/// was the smallest that counts (kLeastSkid), and twice as many after a change of 14 degrees.
constexpr double kMaxSkids = 5.0;

/// Five cycles of the slowest radar, a Bosch GPR. After that nothing of a radar ahead holds the
/// speed.
constexpr double kGoneS = 0.5;
/// Of a Doppler scale that all radars share, as their positions tell it.
constexpr double kLearnedScaleStd = 0.02;
/// 27 degrees. Four healthy radars at 43 degrees learned 1 % in 5 minutes of a simulated motorway,
/// two at 45 learned 4.5 % in 20 minutes of starts and stops. The front radars of RadarScenes are
/// at 25.
constexpr double kMaxSineOfScale = 0.45;
constexpr int kMostRadars = 16;
static_assert(size(kMostRadars) + kVehicleStates <= Innovation::kMaxStates);

int size_of(std::size_t radars, const OdometryOptions& options) {
  return size(static_cast<int>(radars)) + (options.vehicle.is_used() ? kVehicleStates : 0);
}

/// Indices of the states that MotionStep propagates, and of a pose.
const auto kMotion = Eigen::seqN(kX, Eigen::fix<kMotionStates>);
auto pose_at(int first) { return Eigen::seqN(first, Eigen::fix<kPose>); }

int first_of(std::size_t radar) { return state_layout::radar(static_cast<int>(radar)); }

std::vector<LearnedError> unlearned_of(const OdometryOptions& options,
                                       const std::vector<Pose2>& mounts,
                                       LearnedError LearnedErrors::*which) {
  std::vector<LearnedError> unlearned;
  unlearned.reserve(mounts.size());
  for (const Pose2& mount : mounts) {
    unlearned.push_back(unlearned_errors(options, mount).*which);
  }
  return unlearned;
}

SharedPrior prior_of(const OdometryOptions& options, const std::vector<Pose2>& mounts,
                     const std::vector<std::optional<LearnedErrors>>& learned,
                     LearnedError LearnedErrors::*which, double restart_std) {
  std::vector<std::optional<LearnedError>> errors(mounts.size());
  for (std::size_t i = 0; i < mounts.size(); ++i) {
    if (i < learned.size() && learned[i]) {
      errors[i] = (*learned[i]).*which;
    }
  }
  return prior_after(errors, unlearned_of(options, mounts, which), restart_std);
}

}  // namespace

OdometryState::OdometryState(const OdometryOptions& options, std::vector<Pose2> mounts,
                             const std::vector<std::optional<LearnedErrors>>& learned)
    : gaussian(size_of(mounts.size(), options), options.vehicle.is_used()),
      options_(options),
      mounts_(std::move(mounts)),
      ahead_(
          filter(first_radars(radars()), [&](std::size_t i) { return !looks_across(mounts_[i]); })),
      along_(filter(first_radars(radars()),
                    [&](std::size_t i) { return sine_off_travel(mounts_[i]) < kMaxSineOfScale; })),
      heard_us_(mounts_.size()),
      is_turned_(mounts_.size()),
      mount_yaw_(prior_of(options, mounts_, learned, &LearnedErrors::mount_yaw_rad,
                          options.mount_yaw_restart_std_rad)),
      doppler_scale_(prior_of(options, mounts_, learned, &LearnedErrors::doppler_scale,
                              options.doppler_scale_restart_std)),
      common_errors_(cremed::common_errors(options)) {
  for (std::size_t i = 0; i < mounts_.size(); ++i) {
    radar_errors_.push_back(cremed::radar_errors(options, mounts_[i], first_of(i)));
  }
  if (options.vehicle.is_used()) {
    for (const VehicleSignal signal : {VehicleSignal::speed, VehicleSignal::yaw_rate}) {
      signal_errors_.push_back(
          cremed::signal_errors(options.vehicle, signal, first_of(mounts_.size())));
    }
  }
  for_each_error([&](const StateError& error) {
    if ((error.considered_by & StateError::kVelocities) != 0) {
      considered_.by_velocities.push_back({error.state});
    }
    if ((error.considered_by & StateError::kYAndYaw) != 0) {
      considered_.by_positions.push_back(
          {error.state, (error.considered_by & StateError::kX) != 0 ? 0 : 1});
    }
    if ((error.considered_by & StateError::kAtRest) != 0) {
      considered_at_rest_.push_back({error.state});
    }
  });
  considered_without_scales_ = considered_;
  for (std::size_t i = 0; i < mounts_.size(); ++i) {
    const int scale = this->error(i, kDopplerScale);
    considered_without_scales_.by_velocities.push_back({scale});
    considered_without_scales_.by_positions.push_back({scale, 1});
  }
}

template <typename Visit>
void OdometryState::for_each_error(Visit visit) const {
  std::for_each(common_errors_.begin(), common_errors_.end(), visit);
  for (const auto* groups : {&radar_errors_, &signal_errors_}) {
    for (const std::vector<StateError>& errors : *groups) {
      std::for_each(errors.begin(), errors.end(), visit);
    }
  }
}

void OdometryState::hear(std::size_t radar, std::int64_t stamp_us) {
  const auto newest_us = *std::max_element(heard_us_.begin(), heard_us_.end());
  if (!newest_us || seconds_between(*newest_us, stamp_us) > kGoneS) {
    // At the start, or after a silence of all, none is gone before its time.
    std::fill(heard_us_.begin(), heard_us_.end(), stamp_us);
  }
  heard_us_[radar] = std::max(heard_us_[radar], std::optional(stamp_us));
}

RadarSet OdometryState::heard(std::int64_t at_us) const {
  return filter(first_radars(radars()), [&](std::size_t i) {
    return !heard_us_[i] || seconds_between(*heard_us_[i], at_us) <= kGoneS;
  });
}

/// Whether Doppler scales are learned: by several radars, one of which looks within 27 degrees of
/// the direction of travel. Otherwise they are not told apart from the speed well enough.
bool OdometryState::is_scale_observed() const {
  const RadarSet heard = this->heard(time_us_);
  return std::popcount(heard) > 1 && (heard & along_) != 0;
}

void OdometryState::update(const Innovation& innovation, bool is_of_positions) {
  for (const VehicleSignal signal : {VehicleSignal::speed, VehicleSignal::yaw_rate}) {
    const auto by_faults = innovation.whitened_by_faults.middleCols<3>(fault_of(signal));
    FaultEvidence& evidence = fault_evidence_[static_cast<std::size_t>(signal)];
    evidence.information += by_faults.transpose() * by_faults;
    evidence.weighted += by_faults.transpose() * innovation.whitened;
  }
  const bool is_at_rest = std::abs(gaussian.mean(kSpeed)) < options_.standstill_mps;
  const Considered& considered = is_scale_observed() ? considered_ : considered_without_scales_;
  const auto& driving = is_of_positions ? considered.by_positions : considered.by_velocities;
  gaussian.update(innovation, is_at_rest ? considered_at_rest_ : driving);
}

void OdometryState::start() {
  for (int i = 0; i < gaussian.size(); ++i) {
    gaussian.set(i, 0.0, 0.0);
  }
  for_each_error([&](const StateError& error) { start(error); });
  gaussian.set_mean(kSlipPerAcceleration, options_.slip_per_lateral_acceleration);
  start_shared(kMountYaw, mount_yaw_);
  start_shared(kDopplerScale, doppler_scale_);
  restart(0);
}

void OdometryState::restart(std::int64_t time_us) {
  time_us_ = time_us;
  excess_m2ps2_ = 0.0;
  mixture_variance_ = 0.0;
  if (is_skidding_ || squared(gaussian.mean(kSlip)) > least_skid()) {
    gaussian.set(kSlip, 0.0, squared(options_.slip_std_rad));
  }
  skid_variance_ = 0.0;
  is_skidding_ = false;
  for (int i = 0; i < kPose; ++i) {
    gaussian.set(i, 0.0, 0.0);
  }
  for (int i = kOutput; i < kFirstRadar; ++i) {
    gaussian.set(i, 0.0, 0.0);
  }
  start_motion(Eigen::Vector2d::Zero(), Eigen::Vector2d(squared(options_.start_speed_std_mps),
                                                        squared(options_.start_yaw_rate_std_radps))
                                            .asDiagonal());
  start_scene_errors();
}

/// Sets an error to its prior.
void OdometryState::start(const StateError& error) {
  gaussian.set(error.state, 0.0, squared(error.std_at(0.0, 0.0)));
}

void OdometryState::start_shared(int which, const SharedPrior& prior) {
  for (std::size_t i = 0; i < prior.own.size(); ++i) {
    gaussian.set(error(i, which), prior.own[i].value, squared(prior.own[i].std));
  }
  for (std::size_t i = 0; i < prior.own.size(); ++i) {
    for (std::size_t j = 0; j < prior.own.size(); ++j) {
      if (prior.own[i].is_learned && prior.own[j].is_learned) {
        gaussian.add_covariance(error(i, which), error(j, which), prior.common_variance);
      }
    }
  }
}

void OdometryState::start_motion(const Eigen::Vector2d& value, const Eigen::Matrix2d& covariance) {
  gaussian.set(kSpeed, value.x(), covariance(0, 0));
  gaussian.set(kAcceleration, 0.0, squared(options_.acceleration.std));
  gaussian.set(kYawRate, value.y(), covariance(1, 1));
  gaussian.set(kYawAcceleration, 0.0, squared(options_.yaw_acceleration.std));
  gaussian.add_covariance(kSpeed, kYawRate, covariance(0, 1));
  gaussian.add_covariance(kYawRate, kSpeed, covariance(1, 0));
  forget_faults();
}

void OdometryState::widen_errors(std::size_t radar) {
  for (const StateError& error : radar_errors_[radar]) {
    if (error.reset == StateError::Reset::doubt) {
      // That of a mount that turned is larger.
      const double variance = std::max(gaussian.variance(error.state), squared(error.process.std));
      gaussian.set(error.state, gaussian.mean(error.state), variance);
    }
  }
  start_scene_errors(radar);
  forget_faults();
}

void OdometryState::start_scene_errors() {
  for_each_error([&](const StateError& error) {
    if (error.reset == StateError::Reset::scene) {
      start(error);
    }
  });
}

void OdometryState::start_scene_errors(std::size_t radar) {
  for (const StateError& error : radar_errors_[radar]) {
    if (error.reset == StateError::Reset::scene) {
      start(error);
    }
  }
}

void OdometryState::widen_scale(std::size_t radar, double std) {
  gaussian.add_variance(error(radar, kDopplerScale), squared(std));
}

void OdometryState::start_scale(double error_mps) {
  gaussian.set(kCommonScale, 0.0, squared(kLearnedScaleStd));
  const Eigen::Vector2d motion(gaussian.mean(kSpeed) + error_mps, gaussian.mean(kYawRate));
  start_motion(motion, Eigen::Vector2d(gaussian.variance(kSpeed) + squared(error_mps),
                                       gaussian.variance(kYawRate))
                           .asDiagonal());
  start_scene_errors();
}

void OdometryState::turn_mount(std::size_t radar, double yaw_rad, double std_rad) {
  gaussian.set(kSlip, 0.0, squared(options_.slip_std_rad));
  gaussian.set(error(radar, kMountYaw), yaw_rad, squared(std_rad));
  // The speed has the part of the error that the linear model leaves out.
  set_scale_variance(radar, squared(options_.doppler_scale_std) + squared(1.0 - std::cos(yaw_rad)));
  is_turned_[radar] = std::abs(yaw_rad) > kGateSigmas * options_.mount_yaw_std_rad;
}

void OdometryState::turn_mounts(RadarSet radars, double by_rad, double std_rad) {
  gaussian.set(kSlip, 0.0, squared(options_.slip_std_rad));
  for_each(radars, [&](std::size_t i) {
    const int yaw = error(i, kMountYaw);
    gaussian.set_mean(yaw, gaussian.mean(yaw) + by_rad);
    for_each(radars, [&](std::size_t other) {
      gaussian.add_covariance(yaw, error(other, kMountYaw), squared(std_rad));
    });
    is_turned_[i] = true;
    start_scene_errors(i);
  });
  forget_faults();
}

void OdometryState::turn_mount_back(std::size_t radar) {
  gaussian.set(error(radar, kMountYaw), 0.0, squared(options_.mount_yaw_std_rad));
  set_scale_variance(radar, squared(options_.doppler_scale_std));
  is_turned_[radar] = false;
}

void OdometryState::set_scale_variance(std::size_t radar, double variance) {
  const int scale = error(radar, kDopplerScale);
  gaussian.set(scale, gaussian.mean(scale), variance);
}

void OdometryState::advance_to(std::int64_t time_us) {
  for (double left_s = seconds_between(time_us_, time_us); left_s > 0.0;
       left_s -= kMaxMotionStepS) {
    const double step_s = std::min(left_s, kMaxMotionStepS);
    const MotionStep step =
        moved(gaussian.mean().head<kMotionStates>(), step_s, options_, skid_variance());
    const double before = variance_by_product(gaussian.covariance().topLeftCorner<kPose, kPose>());
    gaussian.set_to(kMotion, step.state, kMotion, step.jacobian, step.noise);
    const double after = variance_by_product(gaussian.covariance().topLeftCorner<kPose, kPose>());
    excess_m2ps2_ *= std::exp(-step_s / kExcessTimeS);
    advance_skid(step_s);
    gaussian.add_variance(kX, std::max(0.0, after - before));
    gaussian.add_variance(kY, std::max(0.0, after - before));
    for (const StateError& error : common_errors_) {
      if (error.state >= kMotionStates) {
        advance(error, step_s);
      }
    }
  }
  time_us_ = std::max(time_us_, time_us);
}

VehicleEstimate OdometryState::vehicle() const {
  return {gaussian.mean().head<kMotionStates>(),
          gaussian.covariance().topLeftCorner<kMotionStates, kMotionStates>(), skid_variance()};
}

void OdometryState::advance_errors(std::size_t radar, double dt_s) {
  const int mount_yaw = error(radar, kMountYaw);
  const double mount_yaw_rad = gaussian.mean(mount_yaw);
  for (const StateError& error : radar_errors_[radar]) {
    advance(error, dt_s);
  }
  if (is_turned_[radar]) {
    gaussian.set_mean(mount_yaw, mount_yaw_rad);
  }
}

void OdometryState::advance(const StateError& error, double dt_s) {
  const ErrorProcess& process = error.process;
  if (std::isinf(process.time_s)) {
    gaussian.add_variance(error.state, squared(process.walk) * dt_s);
    return;
  }
  const double speed_mps = gaussian.mean(kSpeed);
  const double driving = process.only_driving ? driving_share(speed_mps) : 1.0;
  const double left = std::exp(-(driving * dt_s) / process.time_s);
  double std = error.std_at(speed_mps, gaussian.mean(kYawRate));
  if (error.state == kMixture) {
    std = std::hypot(std, mixture_std());
    mixture_variance_ += (squared(std) - mixture_variance_) * (1.0 - left * left);
  }
  gaussian.decay(error.state, left, squared(std) * (1.0 - left * left));
}

void OdometryState::add_excess(double excess_m2ps2) {
  excess_m2ps2_ = std::max(excess_m2ps2_, excess_m2ps2);
  // Cars start within a second: the process grows at once, and falls in its own time.
  grow(kMixture, mixture_variance_, squared(mixture_std()));
}

/// Returns false if it is as large already.
bool OdometryState::grow(int state, double& variance, double to) {
  const double more = to - variance;
  if (more > 0.0) {
    gaussian.add_variance(state, more);
    variance = to;
  }
  return more > 0.0;
}

double OdometryState::mixture_std() const {
  const double slow =
      std::clamp(2.0 - 2.0 * std::abs(gaussian.mean(kSpeed)) / kMaxMixedMps, 0.0, 1.0);
  return slow * kShiftPerExcess * std::sqrt(excess_m2ps2_);
}

void OdometryState::add_jolt(double since_s) {
  // Of all accelerations up to the limit.
  const double variance =
      std::max(0.0, squared(kMaxAccelerationMps2) / 3.0 - gaussian.variance(kAcceleration));
  const double yaw_rad = gaussian.mean(kYaw);
  const double way_s2 = 0.5 * squared(since_s);
  const std::array<std::pair<int, double>, 4> changes{{{kX, way_s2 * std::cos(yaw_rad)},
                                                       {kY, way_s2 * std::sin(yaw_rad)},
                                                       {kSpeed, since_s},
                                                       {kAcceleration, 1.0}}};
  for (const auto& [i, of_i] : changes) {
    for (const auto& [j, of_j] : changes) {
      gaussian.add_covariance(i, j, of_i * of_j * variance);
    }
  }
}

void OdometryState::add_skid(double slip_rad) {
  is_skidding_ = grow(kSlip, skid_variance_, squared(slip_rad)) || is_skidding_;
}

/// After the state was moved with skid_variance().
void OdometryState::advance_skid(double dt_s) {
  skid_variance_ *= std::exp(-dt_s / kSkidS);
  is_skidding_ = is_skidding_ && skid_variance_ + squared(gaussian.mean(kSlip)) > least_skid() &&
                 skid_variance_ > std::exp(-kMaxSkids) * least_skid();
  skid_variance_ = is_skidding_ ? skid_variance_ : 0.0;
  since_skid_s_ = is_skidding_ ? 0.0 : since_skid_s_ + dt_s;
}

double OdometryState::least_skid() const { return squared(kLeastSkid * options_.slip_std_rad); }

double OdometryState::skid_variance() const {
  return is_skidding_ ? skid_variance_ + squared(gaussian.mean(kSlip)) : 0.0;
}

void OdometryState::correct_fault(VehicleSignal signal, const Eigen::Vector3d& errors,
                                  const Eigen::Matrix3d& covariance) {
  gaussian.correct_faults(fault_of(signal), errors, covariance);
  // The evidence of the other signal took this one for right.
  fault_evidence_.fill({.since_us = time_us_});
  forget_faults(signal);
}

void OdometryState::forget_faults(VehicleSignal signal) {
  if (options_.vehicle.is_used()) {
    gaussian.forget_faults(fault_of(signal));
    fault_evidence_[static_cast<std::size_t>(signal)] = {.since_us = time_us_};
  }
}

void OdometryState::forget_faults() {
  forget_faults(VehicleSignal::speed);
  forget_faults(VehicleSignal::yaw_rate);
}

void OdometryState::start_signal(VehicleSignal signal) {
  for (const StateError& error : signal_errors(signal)) {
    start(error);
  }
}

void OdometryState::advance_signal(VehicleSignal signal, double dt_s) {
  for (const StateError& error : signal_errors(signal)) {
    advance(error, dt_s);
  }
}

Eigen::Vector2d OdometryState::radar_velocity(std::size_t radar) const {
  const double w = gaussian.mean(kYawRate);
  return {gaussian.mean(kSpeed) - w * mounts_[radar].y_m, w * mounts_[radar].x_m};
}

OdometryState::PastPose OdometryState::pose_before(double age_s) const {
  const MotionStep step = moved(gaussian.mean().head<kMotionStates>(), -age_s, options_);
  return {step.state.head<kPose>(), step.jacobian.topRows<kPose>()};
}

void OdometryState::clone_node(std::size_t node, double age_s) {
  const PastPose past = pose_before(age_s);
  gaussian.set_to(pose_at(state_layout::node(node)), past.pose, kMotion, past.by_motion);
}

Eigen::Vector3d OdometryState::node_pose(std::size_t node) const {
  return gaussian.mean().segment<kPose>(state_layout::node(node));
}

void OdometryState::clone_output() {
  gaussian.set_to(pose_at(kOutput), gaussian.mean().head<kPose>().eval(), pose_at(kX),
                  Eigen::Matrix3d::Identity().eval());
}

void OdometryState::renew_anchor() {
  const Eigen::Vector3d anchor = gaussian.mean().head<kPose>();
  const auto renew = [&](int pose) {
    const Eigen::Vector3d relative = relative_pose(anchor, gaussian.mean().segment<kPose>(pose));
    gaussian.set_to(pose_at(pose), relative, std::array{kX, kY, kYaw, pose, pose + 1, pose + 2},
                    relative_pose_jacobian(anchor, relative));
  };
  renew(kOutput);
  for (std::size_t i = 0; i < kNodes; ++i) {
    renew(node(i));
  }
  for (int i = 0; i < kPose; ++i) {
    gaussian.set(i, 0.0, 0.0);
  }
}

std::vector<LearnedErrors> OdometryState::learned() const {
  const auto differences_of = [&](int which, LearnedError LearnedErrors::*error) {
    std::vector<int> states;
    for (std::size_t i = 0; i < mounts_.size(); ++i) {
      states.push_back(this->error(i, which));
    }
    return differences(gaussian.mean()(states), gaussian.covariance()(states, states),
                       unlearned_of(options_, mounts_, error));
  };
  const auto yaws = differences_of(kMountYaw, &LearnedErrors::mount_yaw_rad);
  const auto scales = differences_of(kDopplerScale, &LearnedErrors::doppler_scale);
  std::vector<LearnedErrors> result;
  for (std::size_t i = 0; i < std::min(yaws.size(), scales.size()); ++i) {
    result.push_back({yaws[i], scales[i]});
  }
  return result;
}

int OdometryState::error(std::size_t radar, int which) const { return first_of(radar) + which; }

int OdometryState::vehicle_error(int which) const { return first_of(mounts_.size()) + which; }

}  // namespace cremed
