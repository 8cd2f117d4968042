// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/position_fusion.hpp"

#include <cmath>

#include "cremed/estimator/fusion/measurement/map_measurement.hpp"
#include "cremed/estimator/fusion/measurement/static_targets.hpp"
#include "cremed/estimator/fusion/state/pose_chain.hpp"
#include "cremed/estimator/scan/squared.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

using namespace state_layout;

/// Least share of the information of x that is of the targets; the rest is the search's prior of
/// 0.1 m (MapRegistration). x is divided by that share, which makes its noise up to five times as
/// large.
constexpr double kMinShareOfX = 0.2;
/// Least share of a scan's targets in the map with which they confirm the state. On healthy drives
/// half to nine tenths are in the map.
constexpr double kMinConfirmedShare = 0.4;
/// A scan with so many static targets has to confirm its speed by positions (FaultHypotheses). Of
/// 10, too few are found in the map too often: a radar with fewer is exempt. Fewer positions of a
/// lateral radar are not used either, because what they show moves along. With 6 the left and right
/// radars of 0796 alone followed it, 94 % of the rows beyond 5 sigma on one of its starts.
constexpr std::size_t kTellingTargets = 20;
/// Beyond this slow cars are in the map, which then moves along.
constexpr double kMaxMixtureMps = 0.1;

}  // namespace

PositionFusion::PositionFusion(OdometryState& state, RadarConsensus& consensus,
                               FaultHypotheses& faults, const FilterCondition& condition)
    : state_(state),
      consensus_(consensus),
      faults_(faults),
      condition_(condition),
      nodes_(state),
      registration_(state.options().position_std_factor),
      counters_(state.radars()) {
  for (std::size_t i = 0; i < state.radars(); ++i) {
    maps_.push_back(std::make_unique<TargetMap>());
  }
  clear();
}

void PositionFusion::clear() {
  for (const auto& map : maps_) {
    map->clear();
  }
  nodes_.clear();
}

std::optional<PositionFusion::YawRate> PositionFusion::use(std::size_t radar,
                                                           const TargetSet& targets,
                                                           std::int64_t stamp_us) {
  if (state_.is_witness(radar)) {
    return std::nullopt;
  }
  nodes_.advance();
  const double age_s = seconds_between(stamp_us, state_.time_us());
  select_static(state_, radar, age_s, targets, static_targets_);
  counters_[radar].moving += targets.size() - static_targets_.size();
  const bool are_few = static_targets_.size() < kTellingTargets;
  if (are_few) {
    faults_.evidence.add_too_few_targets(radar, stamp_us);
  }
  if ((are_few && looks_across(state_.mount(radar))) ||
      static_targets_.size() < static_cast<std::size_t>(state_.options().min_targets)) {
    return std::nullopt;
  }
  const auto yaw_rate = match(radar, age_s);
  extend_map(radar, stamp_us, age_s);
  return yaw_rate;
}

bool PositionFusion::confirm_state(std::size_t radar, const TargetSet& targets, double age_s) {
  if (state_.is_witness(radar)) {
    return false;
  }
  TargetMap& map = *maps_[radar];
  map.place(MapMeasurement{state_, map, radar, age_s}.now_from_node());
  const auto match = registration_.solve(targets, map, state_.mount(radar));
  return match && match->matched >= kMinConfirmedShare * static_cast<double>(targets.size()) &&
         std::abs(match->correction.x()) <= kMaxConfirmedM;
}

std::optional<PositionFusion::YawRate> PositionFusion::match(std::size_t radar, double age_s) {
  TargetMap& map = *maps_[radar];
  const MapMeasurement from_map{state_, map, radar, age_s};
  map.place(from_map.now_from_node());
  const auto match = registration_.solve(static_targets_, map, state_.mount(radar));
  const auto possible = static_cast<double>(static_targets_.size());
  MapCounters& counters = counters_[radar];
  counters.at_rest += map.scans() > 0 ? static_targets_.size() : 0;
  counters.found += match ? static_cast<std::uint64_t>(std::lround(match->matched)) : 0;
  if (!match || match->matched < state_.options().min_matched_share * possible) {
    return std::nullopt;
  }
  RadarTrust& trust = consensus_[radar];
  const bool has_x = !looks_across(state_.mount(radar)) && match->x_share > kMinShareOfX &&
                     state_.mixture_std() < kMaxMixtureMps;
  const bool is_confirmed = match->matched >= kMinConfirmedShare * possible;
  if (has_x && is_confirmed) {
    compare_speed(radar, *match);
  }
  LinearMeasurement measurement = from_map.linearise(*match, has_x);
  measurement.noise *= trust.position_noise.value();
  if (looks_across(state_.mount(radar))) {
    measurement.noise *= state_.options().position_noise_factor_across;
  }
  const Innovation innovation = state_.gaussian.innovate(measurement);
  trust.lateral.add(state_.time_us(), innovation.nis_of_numbers.y());
  trust.yaw.add(state_.time_us(), innovation.nis_of_numbers.z());
  trust.position_noise.add(0.5 * innovation.nis);
  const double max_nis = state_.options().max_position_nis;
  const bool is_contradicted = innovation.nis > max_nis;
  const auto yaw_rate = is_confirmed ? yaw_rate_by(*match) : std::nullopt;
  if (!is_contradicted) {
    state_.update(innovation, true);
  }
  if (!yaw_rate) {
    return std::nullopt;
  }
  return YawRate{*yaw_rate, is_contradicted && innovation.nis_of_numbers.z() > 0.5 * max_nis};
}

/// The yaw rate of the state, corrected by how much further the targets turned.
std::optional<double> PositionFusion::yaw_rate_by(const MapMatch& match) const {
  const double turning_s = since_s(match, 2);
  return turning_s > 0.0
             ? std::optional(state_.gaussian.mean(kYawRate) + match.correction.z() / turning_s)
             : std::nullopt;
}

/// Mean time since the nodes with whose targets a number (x, y, yaw) was compared.
double PositionFusion::since_s(const MapMatch& match, int number) const {
  double since_s = 0.0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    since_s += match.by_node[i](number, number) * nodes_.since_s(i);
  }
  return since_s;
}

/// Tells the speed by positions: that of the state, corrected by how much further they moved.
void PositionFusion::compare_speed(std::size_t radar, const MapMatch& match) {
  const double way_since_s = since_s(match, 0);
  if (!condition_.is_speed_unknown() && way_since_s > 0.0) {
    faults_.evidence.add_speed_by_positions(
        radar, state_.time_us(),
        state_.radar_velocity(radar).x() + match.correction.x() / (match.x_share * way_since_s),
        way_since_s, match.covariance(0, 0) / squared(match.x_share));
  }
}

/// Adds the scan to the newest node, if that has no scan of the radar yet.
void PositionFusion::extend_map(std::size_t radar, std::int64_t stamp_us, double age_s) {
  if (nodes_.add_if_due(stamp_us, age_s)) {
    for (const auto& map : maps_) {
      map->drop(nodes_.newest());
    }
  }
  const std::size_t node = nodes_.newest();
  if (!maps_[radar]->has(node)) {
    maps_[radar]->insert(node, static_targets_, state_.mount(radar),
                         relative_pose(state_.node_pose(node), state_.pose_before(age_s).pose));
  }
}

}  // namespace cremed
