// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/traffic_doubt.hpp"

#include <cmath>

#include "cremed/estimator/scan/gate.hpp"
#include "cremed/estimator/scan/squared.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {

using namespace state_layout;

TrafficDoubt::TrafficDoubt(OdometryState& state, const RadarConsensus& consensus,
                           const FaultHypotheses& faults, const FilterCondition& condition)
    : parked(state),
      state_(state),
      consensus_(consensus),
      faults_(faults),
      condition_(condition),
      two_worlds_(state.mounts().begin(), state.mounts().end()),
      scan_us_(state.radars()) {}

TrafficDoubt::Seen TrafficDoubt::judge(std::size_t radar, const TargetSet& targets,
                                       const DopplerVelocity& velocity, std::int64_t stamp_us,
                                       double possible_change_mps) {
  using Verdict = ParkedVehicle::Verdict;
  scan_us_[radar] = stamp_us;
  const Verdict verdict = judge_parked(radar, targets, velocity, stamp_us);
  if (verdict == Verdict::two_worlds ||
      sees_two_worlds(radar, targets, velocity, possible_change_mps)) {
    return Seen::traffic;
  }
  return verdict == Verdict::undecided ? Seen::undecided : Seen::road;
}

/// If two worlds show, the vehicle is taken to rest, with the speed that it seemed to have as
/// uncertainty. If all believed radars fall silent during the doubt, it ends: as
/// long as it lasts no radar is judged, so that none could be believed again.
ParkedVehicle::Verdict TrafficDoubt::judge_parked(std::size_t radar, const TargetSet& targets,
                                                  const DopplerVelocity& velocity,
                                                  std::int64_t stamp_us) {
  using Verdict = ParkedVehicle::Verdict;
  const Verdict before = parked.verdict();
  if (!parked.is_parked()) {
    return before;
  }
  if (!is_believed(radar)) {
    if (parked.is_in_doubt() && !any_of(heard(), [&](std::size_t i) { return is_believed(i); })) {
      parked.clear();
    }
    return parked.verdict();
  }
  const Verdict of_scan = parked.judge(radar, targets, velocity, stamp_us);
  if (parked.verdict() == Verdict::two_worlds && before != Verdict::two_worlds) {
    rest();
  }
  return of_scan;
}

void TrafficDoubt::rest() {
  const GaussianState& state = state_.gaussian;
  const Eigen::Vector2d variance(squared(state.mean(kSpeed)) + squared(state.std(kSpeed)),
                                 squared(state.mean(kYawRate)) + squared(state.std(kYawRate)));
  state_.start_motion(Eigen::Vector2d::Zero(), variance.asDiagonal());
}

/// By the scan's Doppler and the speeds that the vehicle can reach from the state.
bool TrafficDoubt::sees_two_worlds(std::size_t radar, const TargetSet& targets,
                                   const DopplerVelocity& velocity, double possible_change_mps) {
  const Pose2& mount = state_.mount(radar);
  const double w = state_.gaussian.mean(kYawRate);
  const Eigen::Vector2d& sensor_mps = velocity.velocity_mps;
  const Eigen::Vector3d of_vehicle(sensor_mps.x() + w * mount.y_m, sensor_mps.y() - w * mount.x_m,
                                   w);
  const double std_mps = std::sqrt(velocity.covariance(0, 0));
  return two_worlds_[radar].check(
      targets, of_vehicle, kGateSigmas * std_mps, before(radar), [&](double speed_mps) {
        return std::abs(speed_mps - state_.gaussian.mean(kSpeed)) <= possible_change_mps;
      });
}

TwoWorlds::Before TrafficDoubt::before(std::size_t radar) const {
  using Before = TwoWorlds::Before;
  if (condition_.is_settled() && !condition_.is_speed_unknown()) {
    return Before::motion;
  }
  if (looks_across(state_.mount(radar)) && !state_.is_witness(radar) &&
      (heard() & ~set_of(radar)) == 0) {
    return Before::first_scans_lone_side_radar;
  }
  return faults_.needs_positions() ? Before::fault : Before::first_scans;
}

RadarSet TrafficDoubt::heard() const {
  return filter(first_radars(scan_us_.size()), [&](std::size_t i) {
    return scan_us_[i] &&
           std::abs(seconds_between(*scan_us_[i], state_.time_us())) <= kScanVerdictValidS;
  });
}

bool TrafficDoubt::is_believed(std::size_t radar) const {
  return consensus_[radar].is_trusted && !consensus_.is_left_out(radar);
}

}  // namespace cremed
