// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "cremed/estimator/doubt/scan/two_worlds.hpp"
#include "cremed/estimator/doubt/vehicle/fault_hypotheses.hpp"
#include "cremed/estimator/doubt/vehicle/filter_condition.hpp"
#include "cremed/estimator/doubt/vehicle/parked_vehicle.hpp"
#include "cremed/estimator/doubt/vehicle/radar_consensus.hpp"
#include "cremed/estimator/fusion/measurement/radar_track.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Whether a scan's Doppler shows the road or traffic: vehicles that depart beside a parked one
/// (ParkedVehicle), or move along with a driving one (TwoWorlds).
class TrafficDoubt {
 public:
  enum class Seen : std::uint8_t {
    road,
    undecided,  ///< A parked vehicle starts, or something departs beside it.
    traffic,    ///< Traffic, perhaps: the scan is not used.
  };

  /// The arguments must outlive this object.
  TrafficDoubt(OdometryState& state, const RadarConsensus& consensus, const FaultHypotheses& faults,
               const FilterCondition& condition);

  /// Also resets the state to rest if a parked vehicle is found to rest. `possible_change_mps`:
  /// largest change of the vehicle's speed since the last scan that was used.
  Seen judge(std::size_t radar, const TargetSet& targets, const DopplerVelocity& velocity,
             std::int64_t stamp_us, double possible_change_mps);

  ParkedVehicle parked;

 private:
  ParkedVehicle::Verdict judge_parked(std::size_t radar, const TargetSet& targets,
                                      const DopplerVelocity& velocity, std::int64_t stamp_us);
  bool sees_two_worlds(std::size_t radar, const TargetSet& targets, const DopplerVelocity& velocity,
                       double possible_change_mps);
  [[nodiscard]] TwoWorlds::Before before(std::size_t radar) const;
  /// Radars with a scan in the last 0.3 s.
  [[nodiscard]] RadarSet heard() const;
  [[nodiscard]] bool is_believed(std::size_t radar) const;
  void rest();

  OdometryState& state_;
  const RadarConsensus& consensus_;
  const FaultHypotheses& faults_;
  const FilterCondition& condition_;
  std::vector<TwoWorlds> two_worlds_;                 // By radar.
  std::vector<std::optional<std::int64_t>> scan_us_;  // Last scan, by radar.
};

}  // namespace cremed
