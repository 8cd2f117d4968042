// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/odometry_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "cremed/estimator/fusion/measurement/doppler_measurement.hpp"
#include "cremed/estimator/fusion/measurement/map_measurement.hpp"
#include "cremed/estimator/fusion/measurement/static_targets.hpp"
#include "cremed/estimator/fusion/state/pose_chain.hpp"
#include "cremed/estimator/motion/vehicle_limits.hpp"
#include "cremed/estimator/scan/squared.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

using namespace state_layout;

/// Least share of the targets in the information of x. Their prior has a sigma of 0.1 m.
constexpr double kMinShareOfX = 0.2;
/// Least share of a scan's targets in the map, and their largest distance along x, with which they
/// confirm the state. On healthy drives half to nine tenths are in the map.
constexpr double kMinConfirmedShare = 0.4;
constexpr double kMaxConfirmedM = 0.3;
/// Gate between a speed and the expected one. False-alarm rate: 1 in 370.
constexpr double kMaxSpeedSigmas = 3.0;
/// From so many scans on, 0.75 s of three radars, the state is not that of a wrong first radar,
/// which the others tell within 0.4 s.
constexpr int kMinScansOfState = 30;

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
    : state_(options, mounts(radars), learned_before(radars)),
      nodes_(state_),
      registration_(options.position_std_factor),
      consensus_(state_),
      faults_(state_),
      condition_(state_, consensus_, faults_),
      parked_(state_),
      output_(state_),
      vehicle_(state_, output_) {
  for (const OdometryRadar& radar : radars) {
    tracks_.push_back(std::make_unique<RadarTrack>(state_.options()));
    two_worlds_.emplace_back(radar.vehicle_from_radar);
    has_forward_radar_ = has_forward_radar_ || !looks_across(radar.vehicle_from_radar);
  }
  state_.start();
}

Odometry OdometryFilter::update(std::size_t radar, const TargetSet& targets, std::int64_t stamp_us,
                                bool is_trusted) {
  if (!is_trusted) {
    faults_.accuse(radar, stamp_us);
  }
  is_trusted = is_trusted && !faults_.is_at_fault(radar) && !faults_.is_unknown();
  const auto believed = faults_.take_correction();
  if (believed) {
    add_error_by_radar(*believed);
  }
  begin_if_needed(stamp_us, is_trusted);
  if (is_usable(radar, targets, stamp_us)) {
    vehicle_.use_until(stamp_us, condition_.is_settled() && !condition_.is_speed_unknown());
    output_.advance_to(stamp_us);
    state_.advance_errors(radar, tracks_[radar]->begin(stamp_us));
    set_trusted(radar, is_trusted);
    if (use_doppler(radar, targets, stamp_us)) {
      use_positions(radar, targets, stamp_us);
    }
  }
  // The condition is that of the returned output, from before a renewal of the anchor.
  Odometry odometry = output_.next();
  Odometry result = with_condition(odometry);
  odometry.status = result.status;
  parked_.add_output(odometry);
  if (condition_.settle() || believed) {
    output_.renew_anchor();  // The way until now may be that of a wrong radar.
  }
  return result;
}

std::optional<Odometry> OdometryFilter::predict_next(std::int64_t now_us) {
  if (state_.options().rate_hz == 0 || !has_started_) {
    return std::nullopt;
  }
  const auto odometry = output_.predict_next(now_us);
  return odometry ? std::optional(with_condition(*odometry)) : std::nullopt;
}

void OdometryFilter::compare(std::size_t radar, const EgoMotion& motion, bool is_trusted) {
  faults_.add_motion(radar, motion);
  if (is_trusted && !faults_.is_at_fault(radar)) {
    vehicle_.compare(state_.mount(radar), motion);
  }
}

void OdometryFilter::forget() {
  faults_.clear();
  output_.bridge(state_.options().max_gap_s);
  output_.forget_predictions();
  vehicle_.forget();
  has_started_ = false;
}

Odometry OdometryFilter::with_condition(Odometry odometry) const {
  parked_.widen(odometry);
  odometry.status = condition_.status(odometry);
  odometry.left_out = left_out();
  return odometry;
}

// Start.

void OdometryFilter::begin_if_needed(std::int64_t stamp_us, bool is_trusted) {
  const double gap_s = seconds_between(state_.time_us(), stamp_us);
  const bool is_lost = (condition_.is_lost() && is_trusted && !parked_.is_in_doubt() &&
                        gap_s > -state_.options().max_lateness_s) ||
                       faults_.take_reversal();
  if (has_started_ && (gap_s > state_.options().max_gap_s || is_lost)) {
    if (is_lost) {
      faults_.require_positions();
    }
    output_.bridge(seconds_between(condition_.used_us(), stamp_us));
    has_started_ = false;
  }
  if (!has_started_) {
    restart(stamp_us);
  }
}

void OdometryFilter::restart(std::int64_t stamp_us) {
  for (const auto& track : tracks_) {
    track->clear();
  }
  nodes_.clear();
  consensus_.clear();
  state_.restart(stamp_us);
  condition_.start();
  step_.reset();
  parked_.clear();
  output_.start();
  has_started_ = true;
}

bool OdometryFilter::is_usable(std::size_t radar, const TargetSet& targets,
                               std::int64_t stamp_us) const {
  return seconds_between(stamp_us, state_.time_us()) <= state_.options().max_lateness_s &&
         tracks_[radar]->is_in_order(stamp_us) && targets.is_finite();
}

/// Widens the errors of a radar that is no longer trusted: they may be wrong.
void OdometryFilter::set_trusted(std::size_t radar, bool is_trusted) {
  RadarTrust& trust = consensus_[radar];
  if (trust.is_trusted && !is_trusted) {
    state_.widen_errors(radar);
    trust.doppler_noise.clear();
  }
  trust.is_trusted = is_trusted;
}

/// The state has the error of a radar that was found at fault, and so has the pose since the
/// anchor: as far as known, the difference to `believed`, (v, w, slip) by the others.
void OdometryFilter::add_error_by_radar(const Eigen::Vector3d& believed) {
  GaussianState& state = state_.gaussian;
  const double since_s = output_.anchor_age_s();
  const double v = state.mean(kSpeed);
  const double w = state.mean(kYawRate);
  const double way_m = (v - believed.x()) * since_s;
  const double turn_rad = (w - believed.y()) * since_s;
  const double slip_rad =
      state.mean(kSlip) - state.mean(kSlipPerAcceleration) * v * w - believed.z();
  state.add_variance(kX, squared(way_m));
  state.add_variance(
      kY, squared(believed.x() * since_s) * (squared(slip_rad) + squared(0.5 * turn_rad)));
  state.add_variance(kYaw, squared(turn_rad));
  state.add_variance(kSlip, squared(slip_rad));
}

/// Left-out radars as a bit set: all that are judged if it is not known which is at fault.
std::uint32_t OdometryFilter::left_out() const {
  return consensus_.at_fault() | (faults_.is_unknown() ? faults_.judged() : faults_.at_fault());
}

// Doppler.

bool OdometryFilter::use_doppler(std::size_t radar, const TargetSet& targets,
                                 std::int64_t stamp_us) {
  const auto scan = tracks_[radar]->velocity(targets, expected_velocity(radar));
  if (!scan) {
    return false;
  }
  using Parked = ParkedVehicle::Verdict;
  const Parked parked = judge_parked(radar, targets, *scan, stamp_us);
  if (parked == Parked::two_worlds || sees_two_worlds(radar, targets, *scan, stamp_us)) {
    condition_.doubt();
    return false;
  }
  if (parked != Parked::undecided) {
    faults_.add_velocity(radar, stamp_us, scan->velocity);
  }
  if (faults_.is_unknown()) {
    condition_.doubt();
  }
  if (condition_.is_speed_unknown() && consensus_[radar].is_trusted &&
      condition_.used_scans() == 0) {
    // The speed, and so the distance, was unknown since the start: restart here.
    output_.bridge(0.0);
    state_.restart(state_.time_us());
    output_.restart_anchor();
    state_.gaussian.assume(kSpeed, scan->velocity.velocity_mps.x());
  }
  return take_doppler(radar, targets, *scan, stamp_us);
}

/// Velocity of the sensor by the state; none if the speed is unknown.
std::optional<Eigen::Vector2d> OdometryFilter::expected_velocity(std::size_t radar) const {
  if (condition_.is_speed_unknown()) {
    return std::nullopt;
  }
  const Pose2& mount = state_.mount(radar);
  const double w = state_.gaussian.mean(kYawRate);
  return Eigen::Vector2d(state_.gaussian.mean(kSpeed) - w * mount.y_m, w * mount.x_m);
}

/// What a parked vehicle sees. The way that it seemed to go before two worlds showed, or before it
/// seemed to rest again, remains as uncertainty.
ParkedVehicle::Verdict OdometryFilter::judge_parked(std::size_t radar, const TargetSet& targets,
                                                    const ScanVelocity& scan,
                                                    std::int64_t stamp_us) {
  using Verdict = ParkedVehicle::Verdict;
  const Verdict before = parked_.verdict();
  if (!parked_.is_parked() || !consensus_[radar].is_trusted || consensus_.is_left_out(radar)) {
    return before;
  }
  const Verdict of_scan = parked_.judge(radar, targets, scan.velocity, stamp_us);
  const Verdict now = parked_.verdict();
  if (now == Verdict::two_worlds && before != Verdict::two_worlds) {
    rest();
  } else if (now == Verdict::rests && before == Verdict::undecided) {
    add_way();
  }
  return of_scan;
}

/// The vehicle is taken to rest, with the speed that it seemed to have as uncertainty.
void OdometryFilter::rest() {
  const GaussianState& state = state_.gaussian;
  const Eigen::Vector2d variance(squared(state.mean(kSpeed)) + squared(state.std(kSpeed)),
                                 squared(state.mean(kYawRate)) + squared(state.std(kYawRate)));
  state_.start_motion(Eigen::Vector2d::Zero(), variance.asDiagonal());
  add_way();
}

void OdometryFilter::add_way() {
  const Eigen::Vector3d way = parked_.way();
  for (const int i : {kX, kY, kYaw}) {
    state_.gaussian.add_variance(i, squared(way[i]));
  }
}

/// Whether the radar may have fitted a world that moves along with the vehicle, by its Doppler and
/// by the speeds that the vehicle can reach from the state.
bool OdometryFilter::sees_two_worlds(std::size_t radar, const TargetSet& targets,
                                     const ScanVelocity& scan, std::int64_t stamp_us) {
  const Pose2& mount = state_.mount(radar);
  const double w = state_.gaussian.mean(kYawRate);
  const Eigen::Vector2d& sensor_mps = scan.velocity.velocity_mps;
  const Eigen::Vector3d velocity(sensor_mps.x() + w * mount.y_m, sensor_mps.y() - w * mount.x_m, w);
  const double std_mps = std::sqrt(scan.velocity.covariance(0, 0));
  const double max_difference_mps = possible_speed_change_mps(stamp_us);
  using Before = TwoWorlds::Before;
  const Before before = condition_.is_settled() && !condition_.is_speed_unknown() ? Before::motion
                        : faults_.needs_positions()                               ? Before::fault
                                                                                  : Before::nothing;
  return two_worlds_[radar].check(
      targets, velocity, kMaxSpeedSigmas * std_mps, before, [&](double speed_mps) {
        return std::abs(speed_mps - state_.gaussian.mean(kSpeed)) <= max_difference_mps;
      });
}

/// Largest change of the speed that a vehicle can make since the last scan that was used.
double OdometryFilter::possible_speed_change_mps(std::int64_t stamp_us) const {
  const double since_s = seconds_between(std::min(condition_.used_us(), stamp_us), stamp_us);
  return kMaxSpeedSigmas * state_.gaussian.std(kSpeed) + kMaxAccelerationMps2 * since_s;
}

bool OdometryFilter::take_doppler(std::size_t radar, const TargetSet& targets,
                                  const ScanVelocity& scan, std::int64_t stamp_us) {
  RadarTrust& trust = consensus_[radar];
  const double age_s = seconds_between(stamp_us, state_.time_us());
  LinearMeasurement measurement = DopplerMeasurement{state_, radar, age_s}.linearise(scan.velocity);
  measurement.noise *= trust.doppler_noise.value();
  if (is_witness(radar)) {
    measurement.noise *= state_.options().doppler_noise_factor_across;
  }
  const double nis = state_.gaussian.innovate(measurement);
  const bool is_expected = nis <= state_.options().max_doppler_nis;
  trust.doppler.add(stamp_us, 0.5 * nis);
  trust.judge(stamp_us, scan.velocity, is_expected);
  const bool is_used = !consensus_.is_left_out(radar) && trust.is_trusted;
  if (is_used) {
    trust.doppler_noise.add(0.5 * nis);
  }
  if (!is_expected) {
    trust.contradicts_positions = positions_confirm_state(radar, targets, age_s);
    follow_majority(stamp_us);
    return false;
  }
  trust.contradicts_positions = false;
  if (has_stepped() && is_after_step(radar, scan)) {
    condition_.doubt();
    return false;
  }
  if (is_used) {
    state_.update();
    output_.add_radar(radar);
    if (!is_witness(radar)) {
      condition_.use_scan(scan.is_clear);
    }
  }
  return is_used;
}

/// Since all radars stepped no scan was used.
bool OdometryFilter::has_stepped() const { return step_ && step_->used_us == condition_.used_us(); }

/// Nearer to where they stepped to than to the state, whose sigma grows: without this a step from
/// 5 m/s to 0 was followed half a second later.
bool OdometryFilter::is_after_step(std::size_t radar, const ScanVelocity& scan) const {
  const auto expected = expected_velocity(radar);
  return expected &&
         std::abs(scan.velocity.velocity_mps.x() - expected->x()) > 0.5 * std::abs(step_->mps);
}

/// Whether all targets of a scan, whatever their Doppler, are where the state expects the map: it
/// is then the Doppler that is wrong.
bool OdometryFilter::positions_confirm_state(std::size_t radar, const TargetSet& targets,
                                             double age_s) {
  if (is_witness(radar)) {
    return false;
  }
  TargetMap& map = tracks_[radar]->map;
  map.place(MapMeasurement{state_, map, radar, age_s}.now_from_node());
  const auto match = registration_.solve(targets, map, state_.mount(radar));
  return match && match->matched >= kMinConfirmedShare * static_cast<double>(targets.size()) &&
         std::abs(match->correction.x()) <= kMaxConfirmedM;
}

/// Whether a radar looks sideways, where others do not. Past it the reflections of targets move
/// along with the vehicle: its positions shorten the way by 16 to 38 %, and are not used. It does
/// not hold the odometry either: without the others 1.8 % of the rows were beyond 5 sigma (passing
/// vehicles, nuScenes).
bool OdometryFilter::is_witness(std::size_t radar) const {
  return has_forward_radar_ && looks_across(state_.mount(radar));
}

/// If a majority of radars contradicts the filter and agrees with each other, its velocity is reset
/// to theirs. The pose is widened by the error of the velocity over the time of the contradiction.
void OdometryFilter::follow_majority(std::int64_t stamp_us) {
  const auto majority = consensus_.contradicting_majority(stamp_us);
  if (!majority) {
    return;
  }
  const Eigen::Vector2d wrong(state_.gaussian.mean(kSpeed), state_.gaussian.mean(kYawRate));
  const Eigen::Vector2d error = majority->value() - wrong;
  const double since_s = consensus_.longest_contradiction_s();
  // A step of all radars that no vehicle can make is not followed: the odometry is lost, and
  // positions have to confirm the next start.
  if (condition_.used_scans() >= kMinScansOfState && consensus_.is_step(stamp_us) &&
      std::abs(error.x()) > possible_speed_change_mps(stamp_us)) {
    step_ = Step{condition_.used_us(), error.x()};
  }
  // The positions can tell which of the speeds is wrong once they would be that far apart.
  if (has_stepped() || (std::abs(error.x()) * since_s > 2.0 * kMaxConfirmedM &&
                        consensus_.contradicts_positions(stamp_us))) {
    condition_.doubt();
    return;
  }
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (consensus_[i].has_agreed()) {
      state_.widen_errors(i);
    } else {
      consensus_[i].forgive();
    }
  }
  if (std::abs(error.x()) > state_.options().static_doppler_mps) {
    // The maps hold what seemed at rest at the wrong speed.
    clear_maps();
  }
  state_.start_motion(majority->value(), majority->covariance());
  vehicle_.restart_errors();
  state_.gaussian.add_variance(kX, squared(error.x() * since_s));
  state_.gaussian.add_variance(kY, squared(error.x() * since_s));
  state_.gaussian.add_variance(kYaw, squared(error.y() * since_s));
}

void OdometryFilter::clear_maps() {
  for (const auto& track : tracks_) {
    track->map.clear();
  }
  nodes_.clear();
}

// Positions.

void OdometryFilter::use_positions(std::size_t radar, const TargetSet& targets,
                                   std::int64_t stamp_us) {
  if (is_witness(radar)) {
    return;
  }
  const double age_s = seconds_between(stamp_us, state_.time_us());
  select_static(state_, radar, age_s, targets, static_targets_);
  tracks_[radar]->counters.moving += targets.size() - static_targets_.size();
  if (static_targets_.size() >= static_cast<std::size_t>(state_.options().min_targets)) {
    match(radar, age_s);
    extend_map(radar, stamp_us, age_s);
  } else {
    faults_.add_too_few_targets(radar, stamp_us);
  }
}

void OdometryFilter::match(std::size_t radar, double age_s) {
  TargetMap& map = tracks_[radar]->map;
  const MapMeasurement from_map{state_, map, radar, age_s};
  map.place(from_map.now_from_node());
  const auto match = registration_.solve(static_targets_, map, state_.mount(radar));
  const auto possible = static_cast<double>(static_targets_.size());
  MapCounters& counters = tracks_[radar]->counters;
  counters.at_rest += map.scans() > 0 ? static_targets_.size() : 0;
  counters.found += match ? static_cast<std::uint64_t>(std::lround(match->matched)) : 0;
  if (!match || match->matched < state_.options().min_matched_share * possible) {
    return;
  }
  RadarTrust& trust = consensus_[radar];
  const bool has_x = !looks_across(state_.mount(radar)) && match->x_share > kMinShareOfX;
  if (has_x && match->matched >= kMinConfirmedShare * possible) {
    compare_speed(radar, *match);
  }
  LinearMeasurement measurement = from_map.linearise(*match, has_x);
  measurement.noise *= trust.position_noise.value();
  const double nis = state_.gaussian.innovate(measurement);
  trust.lateral.add(state_.time_us(), state_.gaussian.innovations().y());
  trust.yaw.add(state_.time_us(), state_.gaussian.innovations().z());
  trust.position_noise.add(0.5 * nis);
  if (nis <= state_.options().max_position_nis) {
    state_.update(true);
  }
}

/// Tells the speed by positions: that of the state, corrected by how much further they moved.
void OdometryFilter::compare_speed(std::size_t radar, const MapMatch& match) {
  double since_s = 0.0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    since_s += match.by_node[i](0, 0) * seconds_between(nodes_.stamp_us(i), state_.time_us());
  }
  const auto expected = expected_velocity(radar);
  if (expected && since_s > 0.0) {
    faults_.add_speed_by_positions(radar, state_.time_us(),
                                   expected->x() + match.correction.x() / (match.x_share * since_s),
                                   since_s, match.covariance(0, 0) / squared(match.x_share));
  }
}

/// Adds the scan to the newest node, if that has no scan of the radar yet.
void OdometryFilter::extend_map(std::size_t radar, std::int64_t stamp_us, double age_s) {
  if (nodes_.add_if_due(stamp_us, age_s)) {
    for (const auto& track : tracks_) {
      track->map.drop(nodes_.newest());
    }
  }
  const std::size_t node = nodes_.newest();
  if (!tracks_[radar]->map.has(node)) {
    tracks_[radar]->map.insert(node, static_targets_, state_.mount(radar),
                               relative_pose(state_.node_pose(node), state_.pose_before(age_s)));
  }
}

// Reports.

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
  const RadarTrust& trust = consensus_[radar];
  const GaussianState& state = state_.gaussian;
  const int mount_yaw = state_.error(radar, kMountYaw);
  const int doppler_scale = state_.error(radar, kDopplerScale);
  const bool is_left_out = (left_out() >> radar & 1U) != 0;
  return {is_left_out,
          faults_.is_at_fault(radar) ? faults_.cause(radar) : FaultCause(),
          trust.doppler.mean(),
          trust.lateral.mean(),
          trust.yaw.mean(),
          trust.doppler_noise.value(),
          trust.position_noise.value(),
          state.mean(mount_yaw),
          state.std(mount_yaw),
          state.mean(doppler_scale),
          state.std(doppler_scale),
          tracks_[radar]->counters};
}

}  // namespace cremed
