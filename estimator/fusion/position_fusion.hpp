// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "cremed/estimator/doubt/vehicle/fault_hypotheses.hpp"
#include "cremed/estimator/doubt/vehicle/filter_condition.hpp"
#include "cremed/estimator/doubt/vehicle/radar_consensus.hpp"
#include "cremed/estimator/fusion/map/map_nodes.hpp"
#include "cremed/estimator/fusion/map/map_registration.hpp"
#include "cremed/estimator/fusion/map/target_map.hpp"
#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Positions of targets as measurements of the filter's state: the map of each radar, and the
/// registration of its scans against it. Positions of a witness are not used.
class PositionFusion {
 public:
  /// The yaw rate by positions since the nodes, before the state is updated.
  struct YawRate {
    double radps = 0.0;
    bool contradicts_state = false;  ///< By more than max_position_nis, most of it by the yaw.
  };

  /// Largest distance along x between the state and positions that confirm it.
  static constexpr double kMaxConfirmedM = 0.3;

  /// The arguments must outlive this object.
  PositionFusion(OdometryState& state, RadarConsensus& consensus, FaultHypotheses& faults,
                 const FilterCondition& condition);

  /// Updates the state with a scan whose Doppler was used, and its map with the scan. Returns the
  /// yaw rate if the map has most of its targets.
  std::optional<YawRate> use(std::size_t radar, const TargetSet& targets, std::int64_t stamp_us);
  /// Whether all targets of a scan, `age_s` older than the state, are where the state expects the
  /// map, whatever their Doppler: it is then the Doppler that is wrong.
  [[nodiscard]] bool confirm_state(std::size_t radar, const TargetSet& targets, double age_s);
  /// Clears the maps.
  void clear();

  [[nodiscard]] const MapCounters& counters(std::size_t radar) const { return counters_[radar]; }

 private:
  std::optional<YawRate> match(std::size_t radar, double age_s);
  [[nodiscard]] std::optional<double> yaw_rate_by(const MapMatch& match) const;
  [[nodiscard]] double since_s(const MapMatch& match, int number) const;
  void compare_speed(std::size_t radar, const MapMatch& match);
  void extend_map(std::size_t radar, std::int64_t stamp_us, double age_s);

  OdometryState& state_;
  RadarConsensus& consensus_;
  FaultHypotheses& faults_;
  const FilterCondition& condition_;
  MapNodes nodes_;
  MapRegistration registration_;
  std::vector<std::unique_ptr<TargetMap>> maps_;  // By radar.
  std::vector<MapCounters> counters_;
  TargetSet static_targets_;  // Of the present scan.
};

}  // namespace cremed
