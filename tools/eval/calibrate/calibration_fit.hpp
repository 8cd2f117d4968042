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

/// Estimated states of a radar, in this order.
enum CalibrationState : std::size_t {
  kYaw,           ///< Of the mount, rad.
  kX,             ///< Of the mount, m.
  kY,             ///< Of the mount, m.
  kOffset,        ///< Of all Doppler, m/s.
  kStamp,         ///< Added to the radar's stamps, s.
  kScale,         ///< Doppler over true Doppler - 1.
  kLead,          ///< Rotation lead from Doppler, s.
  kPositionLead,  ///< Rotation lead from registrations: delay of their yaw rate, s.
  kAzimuth,       ///< True azimuth over that of its targets - 1.
  // Nuisance parameters, not reported.
  kDopplerAzimuth,  ///< The same, by Doppler alone, over the true one.
  kTurn,            ///< Yaw rate of its registrations over the true one - 1.
  kMatchedTurn,     ///< Yaw rate of its matched targets over that of its azimuths - 1.
};
inline constexpr std::size_t kCalibrationStates = 12;
using CalibrationVector = std::array<double, kCalibrationStates>;

/// Estimated states of the vehicle, in this order.
enum RollingState : std::size_t {
  kRoll,  ///< Rolling direction of the rear axle, from the x axis of the mounts' frame, rad.
  /// Change of that direction, to the outside of a turn, per centripetal acceleration; rad s^2/m.
  kSlip,
};
inline constexpr std::size_t kRollingStates = 2;

/// Unknowns before and after the fit.
template <std::size_t N>
struct Fitted {
  std::array<double, N> prior{};
  std::array<double, N> prior_std{};  ///< 0: held constant.
  std::array<double, N> value{};      ///< Start and result.
  std::array<double, N> std{};        ///< Result.
};
using FittedRadar = Fitted<kCalibrationStates>;
using FittedVehicle = Fitted<kRollingStates>;

/// The vehicle's motion at one time: forward velocity v, yaw rate w, and the body's velocity u to
/// the left relative to the rear axle.
using MotionNode = std::array<double, 3>;

/// Time of a measurement between the nodes of the motion.
struct MotionPlace {
  std::int64_t node = 0;  ///< The preceding node.
  double share = 0.0;     ///< Fraction of the interval to the next node.
  double shift_s = 0.0;   ///< Applied shift of the stamp.
  /// Rate of change of the motion, from the last solution, smoothed over a second. The slope
  /// between two nodes is mostly noise and would make time offsets overconfident.
  MotionNode slope{};
};

/// A radar's velocity at a time, from Doppler.
struct VelocityMeasurement {
  std::size_t radar = 0;
  std::int64_t stamp_us = 0;
  DopplerEquations equations;
};

/// Mean yaw rate between two scans of a radar, from their positions.
struct YawRateMeasurement {
  std::size_t radar = 0;
  CalibrationState gain = kTurn;  ///< Or kMatchedTurn, which the azimuth scale reduces too.
  std::int64_t stamp_us = 0;      ///< The middle between the two.
  double yaw_rate_radps = 0.0;
  double std_radps = 0.0;
};

/// Priors of the change of the vehicle's motion and of its body's motion.
struct MotionPrior {
  double acceleration_std_mps2 = 3.0;
  double yaw_acceleration_std_radps2 = 0.5;
  double body_velocity_std_mps = 0.1;
};

/// All radars and the vehicle in one least-squares problem. The vehicle has a forward velocity v, a
/// yaw rate w and a lateral velocity u of its body at nodes 0.1 s apart, linear in between; its
/// rear axle rolls in the direction s and slips to the outside of a turn by an angle proportional
/// to the acceleration v w. The velocity of a radar at (x, y) with yaw p is, in its own frame,
///
///     R(-p) (v - w y, v (s - slip v w) + u + w x) (1 + scale)
///
/// at the times of its scans, shifted by its stamp offset. Registrations of positions measure w,
/// delayed by the position lead. The motion is determined by the Doppler of several radars, or by
/// truth. Without truth only the mounts' yaw from s is observable.
///
/// Variances come from a jackknife over blocks of 4 s, because errors are correlated for up to a
/// second, which least squares ignores. They are widened for the small number of blocks (variance
/// of Student's t); the contribution of the priors is added.
class CalibrationFit {
 public:
  CalibrationFit(std::vector<FittedRadar> radars, const FittedVehicle& vehicle,
                 const MotionPrior& prior);

  /// Sets the measurements of the next solve(); the states keep their values.
  void set_measurements(std::vector<VelocityMeasurement> velocities,
                        std::vector<YawRateMeasurement> yaw_rates);
  /// Truth refers to the rear axle, in the frame of the mounts.
  void set_truth(const TrueTrajectory* truth) { truth_ = truth; }
  /// Each yaw is known before by this, unless the drive says that it is far off.
  void trust_yaws(const std::vector<double>& std_rad) { yaw_std_rad_ = std_rad; }
  /// Sets the prior standard deviation for the next solve(); values stay.
  void limit(std::size_t radar, CalibrationState state, double std) {
    radars_[radar].prior_std[state] = std::min(radars_[radar].prior_std[state], std);
  }

  void solve();
  /// The same without standard deviations.
  void minimise();

  /// The fit with the measurements within one of so many equal parts of their time, in which pauses
  /// do not count, or with those of the others.
  [[nodiscard]] CalibrationFit part(std::size_t index, std::size_t count, bool is_inside) const;
  /// Half the sum of squares (with outliers weighted down) that these values of the radars, and
  /// this slip if there is one, leave in the measurements at best.
  [[nodiscard]] double misfit(const std::vector<CalibrationVector>& values,
                              const std::optional<double>& slip = {}) const;

  [[nodiscard]] const std::vector<FittedRadar>& radars() const { return radars_; }
  [[nodiscard]] const FittedVehicle& vehicle() const { return vehicle_; }
  /// (v, w, u) at a stamp of the radar, `lead_s` later; nothing outside of the measurements.
  [[nodiscard]] std::optional<Eigen::Vector3d> motion(std::size_t radar, std::int64_t stamp_us,
                                                      double lead_s = 0.0) const;
  /// The expected state of a scan.
  [[nodiscard]] std::optional<DopplerState> expected(std::size_t radar,
                                                     std::int64_t stamp_us) const;

 private:
  friend struct CalibrationProblem;
  [[nodiscard]] MotionPlace place(std::size_t radar, std::int64_t stamp_us, double lead_s) const;
  [[nodiscard]] MotionNode slope(std::int64_t number) const;
  void make_nodes(const MotionPlace& at);

  std::vector<FittedRadar> radars_;
  FittedVehicle vehicle_;
  MotionPrior prior_;
  const TrueTrajectory* truth_ = nullptr;
  std::vector<double> yaw_std_rad_;  // Empty: they are not trusted.
  std::vector<VelocityMeasurement> velocities_;
  std::vector<YawRateMeasurement> yaw_rates_;
  std::map<std::int64_t, MotionNode> nodes_;  // By index.
};

}  // namespace cremed
