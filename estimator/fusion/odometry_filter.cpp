// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/odometry_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "cremed/estimator/fusion/joint_velocity.hpp"
#include "cremed/estimator/fusion/pose_chain.hpp"
#include "cremed/estimator/motion/vehicle_limits.hpp"
#include "cremed/estimator/scan/squared.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

using namespace state_layout;

/// Above it a scan's Doppler is not gated but tells the speed: max_doppler_nis would let pass 4 m/s
/// and more, which other cars differ from us by.
constexpr double kUnknownSpeedStdMps = 1.0;
/// How long the verdict on a radar's scan, or a doubt, counts: four scans of an ARS408, in which a
/// braking vehicle changes its speed by 3 m/s.
constexpr double kVerdictS = 0.3;
/// Longer than kVerdictS: no doubt yet.
constexpr std::int64_t kLongAgoUs = 1'000'000;
/// Of a slow radar: how long a contradiction may have lasted.
constexpr double kScanPeriodS = 0.1;
/// Time-averaged NIS of a radar in doubt above which it contradicts the others: if all of its error
/// stayed the same for a minute, chance would still exceed 5.4 once in 1000 only.
constexpr double kMaxMeanInnovation = 5.0;
/// Radars agree on a velocity up to this mean square, in standard deviations: two that do exceed it
/// once in 135 (chi^2 of three degrees of freedom above 12), more of them less often.
constexpr double kMaxDisagreement = 4.0;
/// Between a speed and the one that is expected, where chance must not decide: once in 370.
constexpr double kSigmas = 3.0;

/// Targets beside the way pass by too fast to be found again four scans later: what registers then
/// turned the yaw of scenes 0061 and 0103 after 10 s by 0.48 and 0.20 degrees, without it 0.34 and
/// 0.18.
bool looks_across(const Pose2& mount) {
  constexpr double kMaxSine = 0.7;  // 45 degrees off the way
  return std::abs(std::sin(mount.yaw_rad)) > kMaxSine;
}

/// To the last bit, as users may expect.
Eigen::Matrix3d symmetric(const Eigen::Matrix3d& matrix) {
  return 0.5 * (matrix + matrix.transpose());
}

std::vector<Pose2> mounts(std::span<const OdometryRadar> radars) {
  std::vector<Pose2> result;
  for (const OdometryRadar& radar : radars) {
    result.push_back(radar.vehicle_from_radar);
  }
  return result;
}

std::vector<std::optional<LearnedErrors>> learned_before(std::span<const OdometryRadar> radars) {
  std::vector<std::optional<LearnedErrors>> result;
  for (const OdometryRadar& radar : radars) {
    result.push_back(radar.learned);
  }
  return result;
}

}  // namespace

OdometryFilter::OdometryFilter(const OdometryOptions& options,
                               std::span<const OdometryRadar> radars)
    : options_(options), state_(options, mounts(radars), learned_before(radars)) {
  for (const OdometryRadar& radar : radars) {
    tracks_.push_back(
        std::make_unique<RadarTrack>(options_, radar.vehicle_from_radar, radar.registration));
  }
}

Odometry OdometryFilter::update(std::size_t radar, const TargetSet& targets, std::int64_t stamp_us,
                                bool is_believed) {
  if (!has_started_) {
    start(stamp_us);
  } else if (const double gap_s = seconds_between(time_us_, stamp_us);
             gap_s > options_.max_gap_s || (is_lost() && is_believed)) {
    bridge(seconds_between(used_us_, stamp_us));
    start(stamp_us);
  }
  if (seconds_between(stamp_us, time_us_) <= options_.max_lateness_s &&
      tracks_[radar]->is_in_order(stamp_us) && targets.is_finite()) {
    advance_to(stamp_us);
    state_.advance_errors(radar, tracks_[radar]->begin(stamp_us));
    believe(radar, is_believed);
    if (use_doppler(radar, targets, stamp_us)) {
      use_positions(radar, targets, seconds_between(stamp_us, time_us_));
    }
  }
  Odometry odometry;
  tell(state_.vehicle(), anchor_, time_us_, odometry);
  odometry.is_new = time_us_ > output_us_;
  if (odometry.is_new) {
    tell_motion(odometry);
  }
  odometry.odom_pose = odom_pose_;
  return odometry;
}

/// Stops at the next anchor if it is on the way.
void OdometryFilter::advance_to(std::int64_t stamp_us) {
  if (next_anchor_us_ && *next_anchor_us_ <= stamp_us) {
    state_.advance(seconds_between(time_us_, *next_anchor_us_));
    time_us_ = *next_anchor_us_;
    renew_anchor();
  }
  state_.advance(seconds_between(time_us_, stamp_us));
  time_us_ = std::max(time_us_, stamp_us);
}

/// What a radar has taught that is believed no longer is forgotten as far as it goes: it may have
/// turned the slip, and its own mount, until it agreed.
void OdometryFilter::believe(std::size_t radar, bool is_believed) {
  RadarTrust& trust = tracks_[radar]->trust;
  if (trust.is_believed && !is_believed) {
    state_.start_errors(radar);
    state_.start_slip();
    trust.doppler_noise.clear();
  }
  trust.is_believed = is_believed;
}

void OdometryFilter::forget() {
  bridge(options_.max_gap_s);
  has_started_ = false;
  predicted_us_ = std::numeric_limits<std::int64_t>::min();
}

/// The pose since the start stays where it was told last; where the vehicle went meanwhile nobody
/// knows.
void OdometryFilter::bridge(double gap_s) {
  const double way_m = options_.start_speed_std_mps * gap_s;
  const double turn_rad = options_.start_yaw_rate_std_radps * gap_s;
  anchor_ = anchor_.next(time_us_, state_.vehicle());
  anchor_.covariance.diagonal() +=
      Eigen::Vector3d(squared(way_m), squared(way_m), squared(turn_rad));
  odom_pose_ = gap_s > 0.0 && predicted_us_ > time_us_ ? predicted_odom_pose_ : odom_pose_;
  anchor_.pose = odom_pose_;
}

void OdometryFilter::start(std::int64_t stamp_us) {
  for (const auto& track : tracks_) {
    track->clear();
  }
  has_started_ = true;
  is_settled_ = false;
  used_scans_ = 0;
  doubt_us_ = stamp_us - kLongAgoUs;
  time_us_ = used_us_ = clear_us_ = stamp_us;
  predicted_us_ = std::max(predicted_us_, stamp_us);
  anchor_here();
}

/// Knowing nothing but that.
void OdometryFilter::anchor_here() {
  state_.start();
  anchor_.utime_us = output_us_ = time_us_;
  next_anchor_us_.reset();
}

bool OdometryFilter::use_doppler(std::size_t radar, const TargetSet& targets,
                                 std::int64_t stamp_us) {
  const Pose2& mount = tracks_[radar]->mount();
  std::optional<Eigen::Vector2d> expected;
  if (!is_unknown()) {
    expected =
        Eigen::Vector2d(state_.gaussian.mean(kSpeed) - state_.gaussian.mean(kYawRate) * mount.y_m,
                        state_.gaussian.mean(kYawRate) * mount.x_m);
  }
  const auto scan = tracks_[radar]->velocity(targets, expected);
  if (!scan) {
    return false;
  }
  if (sees_two_worlds(radar, targets, *scan, stamp_us)) {
    doubt_us_ = time_us_;
    return false;
  }
  if (is_unknown() && tracks_[radar]->trust.is_believed && used_scans_ == 0) {
    // The way since the start cannot be had from a speed that was not known at all.
    bridge(0.0);
    anchor_here();
    state_.gaussian.assume(kSpeed, scan->velocity.velocity_mps.x());
  }
  return take_doppler(radar, *scan, stamp_us);
}

/// Whether the radar may have followed a world that drives as we do: by its own Doppler, and by
/// what the state says that the vehicle can do.
bool OdometryFilter::sees_two_worlds(std::size_t radar, const TargetSet& targets,
                                     const ScanVelocity& scan, std::int64_t stamp_us) {
  RadarTrack& track = *tracks_[radar];
  const double w = state_.gaussian.mean(kYawRate);
  const Eigen::Vector2d& sensor_mps = scan.velocity.velocity_mps;
  const Eigen::Vector3d velocity(sensor_mps.x() + w * track.mount().y_m,
                                 sensor_mps.y() - w * track.mount().x_m, w);
  const double std_mps = std::sqrt(scan.velocity.covariance(0, 0));
  const double since_s = seconds_between(std::min(used_us_, stamp_us), stamp_us);
  const double reach_mps = kSigmas * state_.gaussian.std(kSpeed) + kMaxAccelerationMps2 * since_s;
  return track.two_worlds.look(
      targets, velocity, kSigmas * std_mps, !is_settled_ || is_unknown(), [&](double speed_mps) {
        return std::abs(speed_mps - state_.gaussian.mean(kSpeed)) <= reach_mps;
      });
}

bool OdometryFilter::take_doppler(std::size_t radar, const ScanVelocity& scan,
                                  std::int64_t stamp_us) {
  RadarTrust& trust = tracks_[radar]->trust;
  LinearMeasurement measurement =
      state_.model(radar).doppler(scan.velocity, seconds_between(stamp_us, time_us_));
  measurement.noise *= trust.doppler_noise.value();
  const double nis = state_.gaussian.innovate(measurement);
  const bool is_expected = nis <= options_.max_doppler_nis;
  trust.doppler.add(stamp_us, 0.5 * nis);
  trust.judge(stamp_us, scan.velocity, is_expected);
  if (!trust.is_left_out && trust.is_believed) {
    trust.doppler_noise.add(0.5 * nis);
  }
  if (!is_expected) {
    ask_majority(stamp_us);
    return false;
  }
  if (trust.is_left_out || !trust.is_believed) {
    return false;
  }
  state_.gaussian.update();
  radars_ |= 1U << radar;
  used_us_ = time_us_;
  clear_us_ = scan.is_clear ? time_us_ : clear_us_;
  ++used_scans_;
  is_settled_ = is_settled_ || is_known();
  return true;
}

int OdometryFilter::count_verdicts(std::int64_t stamp_us, bool agree) const {
  return static_cast<int>(std::count_if(tracks_.begin(), tracks_.end(), [&](const auto& track) {
    const RadarTrust& trust = track->trust;
    return trust.has_verdict && trust.is_believed && trust.agrees == agree &&
           seconds_between(trust.verdict_us, stamp_us) <= kVerdictS;
  }));
}

/// If most radars contradict and agree with each other, the velocity begins anew with theirs.
void OdometryFilter::ask_majority(std::int64_t stamp_us) {
  const int agreeing = count_verdicts(stamp_us, true);
  JointVelocity joint(options_);
  for (const auto& track : tracks_) {
    const RadarTrust& trust = track->trust;
    const double age_s = seconds_between(trust.verdict_us, stamp_us);
    if (trust.has_verdict && trust.is_believed && !trust.agrees && age_s <= kVerdictS) {
      joint.add(trust.velocity, track->mount(), age_s);
    }
  }
  if (joint.radars() < 2 || joint.radars() <= agreeing || joint.disagreement() > kMaxDisagreement) {
    return;
  }
  const Eigen::Vector2d wrong(state_.gaussian.mean(kSpeed), state_.gaussian.mean(kYawRate));
  const Eigen::Vector2d error = joint.value() - wrong;
  double since_s = 0.0;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    RadarTrust& trust = tracks_[i]->trust;
    if (trust.has_verdict && trust.agrees) {
      state_.start_errors(i);
    } else {
      since_s = std::max(since_s, trust.contradictions * kScanPeriodS);
      trust.forgive();
    }
  }
  state_.start_motion(joint.value(), joint.covariance());
  // Nobody knows since when the filter was wrong.
  state_.gaussian.add_variance(kX, squared(error.x() * since_s));
  state_.gaussian.add_variance(kY, squared(error.x() * since_s));
  state_.gaussian.add_variance(kYaw, squared(error.y() * since_s));
}

void OdometryFilter::use_positions(std::size_t radar, const TargetSet& targets, double age_s) {
  RadarTrack& track = *tracks_[radar];
  if (looks_across(track.mount())) {
    return;
  }
  const Eigen::Vector3d pose = state_.pose_before(age_s);
  std::array<std::optional<RadarTrack::Pair>, kKeyframes> pairs;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (track.can_match(i, targets)) {
      pairs[i] = track.match(i, targets,
                             state_.model(radar).expected_motion(state_.keyframe(radar, i), pose));
    }
  }
  state_.clone_scan(radar, age_s, options_.scan_noise_share * track.scan_covariance());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i]) {
      use_pair(radar, i, *pairs[i]);
    }
  }
  if (const auto keyframe = track.keep(targets)) {
    state_.keep_scan(radar, *keyframe);
  }
}

void OdometryFilter::use_pair(std::size_t radar, std::size_t keyframe,
                              const RadarTrack::Pair& pair) {
  RadarTrust& trust = tracks_[radar]->trust;
  LinearMeasurement measurement = state_.model(radar).position(state_.keyframe(radar, keyframe),
                                                               state_.scan(radar), pair.motion);
  measurement.noise = trust.position_noise.value() * options_.pair_noise_factor *
                      (options_.pair_noise_start + options_.pair_noise_per_lag * pair.lag) *
                      pair.covariance.bottomRightCorner<2, 2>();
  const double nis = state_.gaussian.innovate(measurement);
  trust.lateral.add(time_us_, state_.gaussian.innovations().x());
  trust.yaw.add(time_us_, state_.gaussian.innovations().y());
  trust.position_noise.add(0.5 * nis);
  if (nis <= options_.max_position_nis) {
    state_.gaussian.update();
  }
}

bool OdometryFilter::is_unknown() const {
  return state_.gaussian.std(kSpeed) > kUnknownSpeedStdMps;
}

bool OdometryFilter::is_known() const {
  return state_.gaussian.std(kSpeed) <= options_.settled_speed_std_mps &&
         state_.gaussian.std(kYawRate) <= options_.settled_yaw_rate_std_radps &&
         used_scans_ >= options_.settled_scans &&
         count_verdicts(time_us_, true) > count_verdicts(time_us_, false);
}

bool OdometryFilter::is_lost() const {
  return seconds_between(used_us_, time_us_) > options_.lost_s;
}

OdometryStatus OdometryFilter::status(const VehicleEstimate& vehicle, std::int64_t utime_us) const {
  const double unused_s = seconds_between(used_us_, utime_us);
  const bool is_doubtful = seconds_between(doubt_us_, utime_us) <= kVerdictS;
  if (is_doubtful && (!is_settled_ || unused_s > options_.predicted_s)) {
    return OdometryStatus::ambiguous;
  }
  if (unused_s > options_.lost_s) {
    return OdometryStatus::lost;
  }
  if (!is_settled_) {
    return count_verdicts(time_us_, false) > 0 ? OdometryStatus::ambiguous
                                               : OdometryStatus::initialising;
  }
  if (unused_s > options_.predicted_s) {
    return OdometryStatus::predicted;
  }
  if (seconds_between(clear_us_, utime_us) > options_.ambiguous_s) {
    return OdometryStatus::ambiguous;
  }
  const auto std = [&](int i) { return std::sqrt(vehicle.covariance(i, i)); };
  const bool stands = std::abs(vehicle.mean(kSpeed)) <= options_.standstill_mps &&
                      std(kSpeed) <= options_.standstill_mps &&
                      std::abs(vehicle.mean(kYawRate)) <= kSigmas * std(kYawRate);
  return stands ? OdometryStatus::standing_still : OdometryStatus::ok;
}

OdometryFilter::Anchor OdometryFilter::Anchor::next(std::int64_t at_us,
                                                    const VehicleEstimate& vehicle) const {
  const Eigen::Vector3d moved = vehicle.mean.head<kPose>();
  return {at_us, composed_pose(pose, moved),
          symmetric(composed_covariance(pose, covariance, moved,
                                        vehicle.covariance.topLeftCorner<kPose, kPose>()))};
}

void OdometryFilter::tell(const VehicleEstimate& vehicle, const Anchor& anchor,
                          std::int64_t utime_us, Odometry& odometry) const {
  odometry.utime_us = utime_us;
  odometry.utime_anchor_us = anchor.utime_us;
  odometry.status = status(vehicle, utime_us);
  odometry.pose = vehicle.mean.head<kPose>();
  odometry.covariance = symmetric(vehicle.covariance.topLeftCorner<kPose, kPose>());
  odometry.odom_covariance = anchor.next(utime_us, vehicle).covariance;
  const double v = vehicle.mean(kSpeed);
  const double slip = vehicle.mean(kSlip);
  Eigen::Matrix3d by_state;
  by_state << 1.0, 0.0, 0.0, slip, 0.0, v, 0.0, 1.0, 0.0;
  constexpr std::array<int, 3> kTwist{kSpeed, kYawRate, kSlip};
  const Eigen::Matrix3d covariance = vehicle.covariance(kTwist, kTwist);
  odometry.twist = {v, slip * v, vehicle.mean(kYawRate)};
  odometry.twist_covariance = symmetric(by_state * covariance * by_state.transpose());
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    odometry.left_out |= tracks_[i]->trust.is_left_out ? 1U << i : 0U;
  }
}

void OdometryFilter::tell_motion(Odometry& odometry) {
  const Eigen::Vector3d before = state_.gaussian.mean().segment<kPose>(kOutput);
  constexpr std::array<int, 6> kPoses{kOutput, kOutput + 1, kOutput + 2, kX, kY, kYaw};
  odometry.utime_before_us = output_us_;
  odometry.motion = relative_pose(before, odometry.pose);
  const auto jacobian = relative_pose_jacobian(before, odometry.motion);
  const Eigen::Matrix<double, 6, 6> covariance = state_.gaussian.covariance()(kPoses, kPoses);
  odometry.motion_covariance = symmetric(jacobian * covariance * jacobian.transpose());
  odometry.radars = radars_;
  odom_pose_ = composed_pose(odom_pose_, odometry.motion);
  output_us_ = time_us_;
  radars_since_prediction_ |= radars_;
  radars_ = 0;
  state_.clone_output();
  if (options_.rate_hz == 0 &&
      seconds_between(anchor_.utime_us, time_us_) >= options_.anchor_period_s) {
    renew_anchor();
  }
}

/// It is where the vehicle is now.
void OdometryFilter::renew_anchor() {
  anchor_ = anchor_.next(time_us_, state_.vehicle());
  state_.renew_anchor();
  next_anchor_us_.reset();
}

/// The state stays where the last scan left it, so that one that was measured before this time
/// still finds it there. It passes a new anchor later than the predictions that are told in its
/// frame.
std::optional<Odometry> OdometryFilter::predict_next(std::int64_t now_us) {
  if (options_.rate_hz == 0 || !has_started_) {
    return std::nullopt;
  }
  const std::int64_t utime_us =
      next_multiple_us(std::max(predicted_us_, time_us_ - 1), options_.rate_hz);
  if (utime_us > now_us || seconds_between(time_us_, utime_us) > options_.max_gap_s) {
    return std::nullopt;
  }
  const Odometry odometry = predicted(utime_us);
  predicted_us_ = utime_us;
  predicted_odom_pose_ = odometry.odom_pose;
  radars_since_prediction_ = 0;
  const double anchored_s = seconds_between(anchor_.utime_us, utime_us);
  if (!next_anchor_us_ && anchored_s >= options_.anchor_period_s) {
    next_anchor_us_ = utime_us;
  }
  return odometry;
}

Odometry OdometryFilter::predicted(std::int64_t utime_us) const {
  VehicleEstimate vehicle = state_.vehicle();
  std::int64_t from_us = time_us_;
  Anchor anchor = anchor_;
  anchor.pose = composed_pose(
      odom_pose_,
      relative_pose(state_.gaussian.mean().segment<kPose>(kOutput), Eigen::Vector3d::Zero()));
  if (next_anchor_us_) {
    vehicle = vehicle.predicted(seconds_between(from_us, *next_anchor_us_), options_);
    from_us = *next_anchor_us_;
    anchor = anchor.next(from_us, vehicle);
    vehicle = vehicle.at_origin();
  }
  Odometry odometry;
  tell(vehicle.predicted(seconds_between(from_us, utime_us), options_), anchor, utime_us, odometry);
  odometry.is_new = true;
  odometry.utime_before_us = predicted_us_;
  odometry.odom_pose = composed_pose(anchor.pose, odometry.pose);
  odometry.radars = radars_since_prediction_;
  return odometry;
}

std::vector<std::optional<LearnedErrors>> OdometryFilter::learned() const {
  std::vector<std::optional<LearnedErrors>> result(tracks_.size());
  const std::vector<LearnedErrors> learned = state_.learned();
  for (std::size_t i = 0; i < learned.size(); ++i) {
    if (!report(i).is_left_out) {
      result[i] = learned[i];
    }
  }
  return result;
}

RadarReport OdometryFilter::report(std::size_t radar) const {
  const RadarTrust& trust = tracks_[radar]->trust;
  const GaussianState& state = state_.gaussian;
  const int mount_yaw = state_.error(radar, kMountYaw);
  const int doppler_scale = state_.error(radar, kDopplerScale);
  const bool contradicts = !trust.is_believed && trust.doppler.exceeds(kMaxMeanInnovation);
  return {trust.is_left_out || contradicts,
          trust.doppler.mean(),
          trust.lateral.mean(),
          trust.yaw.mean(),
          trust.doppler_noise.value(),
          trust.position_noise.value(),
          state.mean(mount_yaw),
          state.std(mount_yaw),
          state.mean(doppler_scale),
          state.std(doppler_scale)};
}

}  // namespace cremed
