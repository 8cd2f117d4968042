// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cremed/estimator/scan/pose2.hpp"
#include "tools/simulate/random.hpp"
#include "tools/simulate/scene.hpp"
#include "tools/simulate/vehicle_course.hpp"

namespace cremed {

/// A radar in the world at one moment.
struct RadarState {
  Pose2 pose;
  double x_mps = 0.0;  ///< Velocity of the radar over ground, in the world's axes.
  double y_mps = 0.0;
};

/// Exact measurement of a point in the radar's frame: x forward, y left.
struct RadarView {
  double range_m = 0.0;
  double azimuth_rad = 0.0;
  double doppler_mps = 0.0;  ///< d(range)/dt
  /// Velocity over ground relative to that of the radar, across the line of sight, to the left.
  double across_mps = 0.0;
  double ground_doppler_mps = 0.0;  ///< The point's own contribution to Doppler: 0 if it is static.
};

RadarState radar_state(const VehicleState& vehicle, const Pose2& vehicle_from_radar);
RadarView view_of(const RadarState& radar, const WorldPoint& point);

/// Visible up to `range_m` within `half_angle_rad` to both sides.
struct BeamZone {
  double half_angle_rad;
  double range_m;
};

/// Field of view and resolution of a radar family.
struct RadarCharacter {
  std::array<BeamZone, 3> zones;  ///< Narrow and far first.
  double least_range_m;
  double range_resolution_m;  ///< Targets closer than all three resolutions merge.
  double azimuth_resolution_rad;
  double doppler_resolution_mps;
  std::size_t mean_ghosts;  ///< False alarms per scan, each in one scan only.
};

enum class EchoKind : std::uint8_t { fixed, vehicle, ghost };

/// One target of a scan, before the radar's measurement errors.
struct Echo {
  EchoKind kind = EchoKind::fixed;
  RadarView view;
  double rcs_dbm2 = 0.0;
  double x_m = 0.0;  ///< Place in the world; not set for a ghost.
  double y_m = 0.0;
};

/// The targets that one radar detects: those in its beam that it can resolve, at random.
class RadarModel {
 public:
  RadarModel(const RadarCharacter& character, const Pose2& vehicle_from_radar, const Scene& scene,
             Random random);

  /// In no particular order. Valid until the next call.
  const std::vector<Echo>& observe(std::int64_t stamp_us);

 private:
  [[nodiscard]] double greatest_range_m(double azimuth_rad) const;
  void detect(EchoKind kind, const WorldPoint& point, double rcs_dbm2, double probability);
  void detect_fixed();
  void detect_vehicles(double time_s);
  void add_ghosts();
  [[nodiscard]] bool same_cell(const RadarView& a, const RadarView& b) const;
  void merge_unresolved();

  RadarCharacter character_;
  Pose2 vehicle_from_radar_;
  const Scene& scene_;
  Random random_;
  RadarState radar_;
  std::vector<Echo> echoes_;
  std::vector<WorldPoint> moving_;
};

}  // namespace cremed
