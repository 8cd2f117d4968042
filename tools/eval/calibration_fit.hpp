// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include <Eigen/Core>

#include "tools/eval/sensor_velocity.hpp"
#include "tools/eval/true_trajectory.hpp"

namespace cremed {

/// What is estimated of a radar, in this order.
enum CalibrationState : std::size_t {
  kYaw,      ///< Of the mount, rad.
  kX,        ///< Of the mount, m.
  kY,        ///< Of the mount, m.
  kOffset,   ///< Of all Doppler, m/s.
  kStamp,    ///< To add to the radar's stamps, s.
  kScale,    ///< Doppler over true Doppler - 1; a nuisance, which is not told.
  kAzimuth,  ///< Azimuth over true azimuth - 1; the same.
  kTurn,     ///< Yaw rate of its registrations over the true one - 1; the same.
};
inline constexpr std::size_t kCalibrationStates = 8;
using CalibrationVector = std::array<double, kCalibrationStates>;

/// A radar before and after the fit.
struct FittedRadar {
  CalibrationVector prior{};
  CalibrationVector prior_std{};  ///< 0: held as it is.
  CalibrationVector value{};      ///< Start and result.
  CalibrationVector std{};        ///< Result.
};

/// A radar's velocity at a time, from Doppler.
struct VelocityMeasurement {
  std::size_t radar = 0;
  std::int64_t stamp_us = 0;
  DopplerEquations equations;
};

/// Mean yaw rate between two scans of a radar, from their registration.
struct YawRateMeasurement {
  std::size_t radar = 0;
  std::int64_t stamp_us = 0;  ///< The middle between the two.
  double yaw_rate_radps = 0.0;
  double std_radps = 0.0;
};

/// How freely the vehicle's motion may change.
struct MotionPrior {
  double acceleration_std_mps2 = 3.0;
  double yaw_acceleration_std_radps2 = 0.5;
};

/// All radars and the vehicle's motion in one least-squares problem. The vehicle has a forward
/// velocity v and a yaw rate w at nodes 0.1 s apart, linear in between; its rear axle does not move
/// sideways. A radar at (x, y) with yaw p moves in its own frame by
///
///     R(-p) (v - w y, w x) (1 + scale)
///
/// at the times of its scans, shifted by its stamp offset. Registrations measure w. The motion is
/// unknown: Doppler of several radars, or truth, fixes it.
///
/// Standard deviations are the larger of two: that of the least squares, and that by leaving out
/// one block of 2 s after the other (jackknife): errors last for some tenths of a second, which the
/// former does not know.
class CalibrationFit {
 public:
  CalibrationFit(std::vector<FittedRadar> radars, const MotionPrior& prior);

  /// For what is measured next, on top of what is measured already.
  void set_measurements(std::vector<VelocityMeasurement> velocities,
                        std::vector<YawRateMeasurement> yaw_rates);
  /// Truth is at the rear axle, its x axis along the way that it goes.
  void set_truth(const TrueTrajectory* truth) { truth_ = truth; }
  /// Sets priors of the next solve(); values stay.
  void hold(std::size_t radar, CalibrationState state) { radars_[radar].prior_std[state] = 0.0; }

  void solve();

  [[nodiscard]] const std::vector<FittedRadar>& radars() const { return radars_; }
  /// (v, w) at a time of a radar's stamps; nothing where nothing was measured.
  [[nodiscard]] std::optional<Eigen::Vector2d> motion(std::size_t radar,
                                                      std::int64_t stamp_us) const;
  /// The state that is expected in a scan.
  [[nodiscard]] std::optional<DopplerState> expected(std::size_t radar,
                                                     std::int64_t stamp_us) const;

 private:
  friend struct CalibrationProblem;
  /// Of the node before a stamp and how far after it, in nodes, without and with stamp offset.
  struct Place {
    std::int64_t node = 0;
    double share_without_offset = 0.0;
  };
  [[nodiscard]] Place place(std::size_t radar, std::int64_t stamp_us) const;

  std::vector<FittedRadar> radars_;
  MotionPrior prior_;
  const TrueTrajectory* truth_ = nullptr;
  std::vector<VelocityMeasurement> velocities_;
  std::vector<YawRateMeasurement> yaw_rates_;
  std::map<std::int64_t, std::array<double, 2>> nodes_;  // By number; (v, w).
};

}  // namespace cremed
