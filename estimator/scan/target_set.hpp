// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "cremed/can_decoders/radar_scan.hpp"
#include "cremed/estimator/scan/detection_options.hpp"
#include "cremed/estimator/scan/pose2.hpp"
#include "cremed/estimator/scan/symmetric2.hpp"

namespace cremed {

/// One target of a registration: a point in the vehicle frame with its covariance, and the Doppler
/// along its line of sight.
struct Target {
  double x_m = 0.0;
  double y_m = 0.0;
  Symmetric2 covariance_m2;
  double bearing_rad = 0.0;  ///< Line of sight in the vehicle frame: azimuth + mounting yaw.
  double cos_bearing = 1.0;
  double sin_bearing = 0.0;
  double bearing_std_rad = 0.0;
  double doppler_mps = 0.0;
  double doppler_std_mps = 0.0;
};

/// Azimuth in the frame of the radar that saw the target.
double azimuth_rad(const Target& target, const Pose2& vehicle_from_radar);
/// Doppler of a target that stands still, if its radar moves so (m/s, vehicle frame).
inline double expected_doppler_mps(const Target& target, double x_mps, double y_mps) {
  return -target.cos_bearing * x_mps - target.sin_bearing * y_mps;
}

/// Numbers of detections used and left out, by reason.
struct SelectionCounters {
  std::uint64_t used = 0;
  std::uint64_t no_noise = 0;
  std::uint64_t invalid_state = 0;
  std::uint64_t moving = 0;
  std::uint64_t low_existence = 0;
  std::uint64_t no_position = 0;
  std::uint64_t outside_limits = 0;
};

/// The usable targets of one scan. The capacity is fixed.
class TargetSet {
 public:
  TargetSet() = default;
  TargetSet(const TargetSet& other) { *this = other; }
  /// Copies the targets, not the unused capacity.
  TargetSet& operator=(const TargetSet& other);
  ~TargetSet() = default;

  void clear() { size_ = 0; }
  /// Adds the target of a detection by a radar at `vehicle_from_radar`. A full set ignores it. A
  /// scan never holds more detections than the capacity.
  void add(const Detection& detection, const Pose2& vehicle_from_radar);
  /// Adds a target of another set. A full set ignores it.
  void add(const Target& target);
  /// Multiplies the Doppler of all targets.
  void scale_doppler(double factor);
  /// Replaces the content by the corrected usable detections of a scan.
  void assign(const RadarScan& scan, const Pose2& vehicle_from_radar, const DetectionLimits& limits,
              SelectionCounters& counters, const DetectionCorrection& correction = {});

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const Target& operator[](std::size_t i) const { return targets_[i]; }
  [[nodiscard]] const Target* begin() const { return targets_.data(); }
  [[nodiscard]] const Target* end() const { return targets_.data() + size_; }
  /// false if any number of any target is NaN or infinite, or a standard deviation is not > 0.
  [[nodiscard]] bool is_finite() const;

 private:
  std::array<Target, kMaxDetections> targets_{};
  std::size_t size_ = 0;
};

/// The detection with Doppler and standard deviations corrected. The rotation lead is not corrected
/// here: its yaw rate is estimated from the whole scan.
Detection corrected(const Detection& detection, const DetectionCorrection& correction);

/// Covariance of a point given in polar coordinates: J diag(range_std^2, azimuth_std^2) J' with J
/// at the measurement, in the frame of `bearing_rad`.
Symmetric2 polar_covariance(double range_m, double bearing_rad, double range_std_m,
                            double azimuth_std_rad);

}  // namespace cremed
