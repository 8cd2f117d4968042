// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "tools/eval/calibrate/sensor_velocity.hpp"
#include "tools/eval/drive/true_trajectory.hpp"

namespace cremed {

/// What is estimated of a radar, in this order.
enum CalibrationState : std::size_t {
  kYaw,           ///< Of the mount, rad.
  kX,             ///< Of the mount, m.
  kY,             ///< Of the mount, m.
  kOffset,        ///< Of all Doppler, m/s.
  kStamp,         ///< To add to the radar's stamps, s.
  kScale,         ///< Doppler over true Doppler - 1.
  kLead,          ///< Rotation lead that Doppler shows, s.
  kPositionLead,  ///< The same that registrations show: how late w is by them, s.
  kAzimuth,       ///< Azimuth over true azimuth - 1; a nuisance, which is not told.
  kTurn,          ///< Yaw rate of its registrations over the true one - 1; the same.
};
inline constexpr std::size_t kCalibrationStates = 10;
using CalibrationVector = std::array<double, kCalibrationStates>;

/// What is estimated of the vehicle, in this order.
enum RollingState : std::size_t {
  kRoll,  ///< Direction the rear axle rolls in, from the x axis of the mounts' frame, rad.
  kSlip,  ///< What that changes by, to the outside of a turn, with acceleration to its inside;
          ///< rad s^2/m.
};
inline constexpr std::size_t kRollingStates = 2;

/// Unknowns before and after the fit.
template <std::size_t N>
struct Fitted {
  std::array<double, N> prior{};
  std::array<double, N> prior_std{};  ///< 0: held as it is.
  std::array<double, N> value{};      ///< Start and result.
  std::array<double, N> std{};        ///< Result.
};
using FittedRadar = Fitted<kCalibrationStates>;
using FittedVehicle = Fitted<kRollingStates>;

/// The vehicle's motion at one time: forward velocity v, yaw rate w, and what the body moves to the
/// left beside the rear axle, u.
using MotionNode = std::array<double, 3>;

/// When a measurement is, between the nodes of the motion.
struct MotionPlace {
  std::int64_t node = 0;  ///< The one before.
  double share = 0.0;     ///< Of the way to the next one.
  double shift_s = 0.0;   ///< What the stamp was shifted by for this.
  /// How the motion changes around, over a second: of the last solution, smoothed. The slope
  /// between two nodes is mostly noise; as a regressor it would promise times that nothing tells.
  MotionNode slope{};
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

/// How freely the vehicle's motion may change, and how its body may move on the axles.
struct MotionPrior {
  double acceleration_std_mps2 = 3.0;
  double yaw_acceleration_std_radps2 = 0.5;
  double body_velocity_std_mps = 0.1;
};

/// All radars and the vehicle in one least-squares problem. The vehicle has a forward velocity v, a
/// yaw rate w and a motion u of its body to the left at nodes 0.1 s apart, linear in between; its
/// rear axle rolls in the direction s, and slips to the outside of a turn by an angle proportional
/// to the acceleration v w. A radar at (x, y) with yaw p moves in its own frame by
///
///     R(-p) (v - w y, v (s - slip v w) + u + w x) (1 + scale)
///
/// at the times of its scans, shifted by its stamp offset. Registrations of positions measure w, by
/// the position lead later. The motion is unknown: Doppler of several radars, or truth, fixes it.
/// Without truth s is not: mounts are then relative to the direction that the vehicle rolls in.
///
/// Variances of what measurements tell come from leaving out one block of 4 s after the other
/// (jackknife): errors last for up to a second, which the variances of least squares do not know.
/// They are widened by what so few blocks leave open (variance of Student's t); what priors tell is
/// added.
class CalibrationFit {
 public:
  CalibrationFit(std::vector<FittedRadar> radars, const FittedVehicle& vehicle,
                 const MotionPrior& prior);

  /// For what is measured next, on top of what is measured already.
  void set_measurements(std::vector<VelocityMeasurement> velocities,
                        std::vector<YawRateMeasurement> yaw_rates);
  /// Truth is at the rear axle, in the frame of the mounts.
  void set_truth(const TrueTrajectory* truth) { truth_ = truth; }
  /// Sets the prior's standard deviation for the next solve(); values stay.
  void limit(std::size_t radar, CalibrationState state, double std) {
    radars_[radar].prior_std[state] = std::min(radars_[radar].prior_std[state], std);
  }

  void solve();

  [[nodiscard]] const std::vector<FittedRadar>& radars() const { return radars_; }
  [[nodiscard]] const FittedVehicle& vehicle() const { return vehicle_; }
  /// (v, w, u) at a time of a radar's stamps, `lead_s` later; nothing where nothing was measured.
  [[nodiscard]] std::optional<Eigen::Vector3d> motion(std::size_t radar, std::int64_t stamp_us,
                                                      double lead_s = 0.0) const;
  /// The state that is expected in a scan.
  [[nodiscard]] std::optional<DopplerState> expected(std::size_t radar,
                                                     std::int64_t stamp_us) const;

 private:
  friend struct CalibrationProblem;
  [[nodiscard]] MotionPlace place(std::size_t radar, std::int64_t stamp_us, double lead_s) const;
  [[nodiscard]] MotionNode slope(std::int64_t number) const;

  std::vector<FittedRadar> radars_;
  FittedVehicle vehicle_;
  MotionPrior prior_;
  const TrueTrajectory* truth_ = nullptr;
  std::vector<VelocityMeasurement> velocities_;
  std::vector<YawRateMeasurement> yaw_rates_;
  std::map<std::int64_t, MotionNode> nodes_;  // By number.
};

}  // namespace cremed
