// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/doubt/vehicle/velocity_moments.hpp"
#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/fusion/state/radar_set.hpp"
#include "cremed/estimator/scan/pose2.hpp"

namespace cremed {

/// Which systematic error explains the velocities of a radar by Doppler.
///
/// Over ten seconds the velocity m that the radar measures is compared with the velocity e that the
/// other radars expect at its mount. Chi-square is (e - f(m))^2 over the noise of healthy radars,
/// which may also have small errors of scale and mount. Causes:
///
///     scale          f(m) = k m
///     offset         f(m) = m + o u, u direction of view
///     sign           f(m) = -m
///     mount yaw      f(m) = m turned
///     upside down    f(m) = m with left and right exchanged in the sensor's frame
///     mount x        f(m) = m + w d across the vehicle
///     late           e at an earlier time
///     exchanged      e at the mount of another radar
///
/// A cause is named if no other one explains the data. But if they fit the mount of another radar
/// that may not be at its own either, it is exchanged, whatever else would explain them.
class FaultCauseSearch {
 public:
  /// `mounts` of all radars, which must outlive this object.
  FaultCauseSearch(std::span<const Pose2> mounts, std::size_t radar);

  /// The motion by the other radars, x = (v, w, slip), and its covariance by random errors; seven
  /// times a second.
  void add_motion(std::int64_t time_us, const Eigen::Vector3d& motion,
                  const Eigen::Matrix3d& covariance);
  /// The radar's velocity at the time of the last motion, in the axes of the vehicle.
  void add_velocity(const Eigen::Vector2d& velocity_mps, const Eigen::Matrix2d& covariance);
  /// Starts again: a fault has begun or ended.
  void clear();
  /// To be called when the clock of the stamps was set.
  void forget();

  /// The best cause, without exchanged mounts.
  struct Finding {
    FaultCause cause;
    double gain = 0.0;      ///< By how much it lowers chi-square; 0: it does not explain the data.
    bool is_clear = false;  ///< No other cause explains the data as well.
  };
  [[nodiscard]] Finding find() const;
  /// The finding that all other radars are late, so that this one seems to be early.
  [[nodiscard]] Finding find_others_late() const;
  /// By how much another radar's mount lowers chi-square; 0: it does not explain the data.
  [[nodiscard]] double gain_at(std::size_t mount) const;
  /// Whether it is surely not exchanged with another one of these: another cause is clear.
  [[nodiscard]] bool is_at_own_mount(RadarSet radars) const {
    return exchanged_with(radars).kind == FaultKind::unknown && find().is_clear;
  }
  /// The cause to be reported. `movable`: the radars with which it may be exchanged.
  [[nodiscard]] FaultCause cause(RadarSet movable) const;

 private:
  static constexpr std::size_t kLags = 6;

  /// What this radar measured.
  struct Own {
    Eigen::Vector2d mps;
    double yaw_rate_radps;  // Of the vehicle, 0 within its noise.
    Eigen::Vector2d weight;
  };
  struct Past {
    std::int64_t time_us = 0;
    Eigen::Vector2d velocity_mps = Eigen::Vector2d::Zero();  // By the others.
    std::optional<Own> own;                                  // If it had a scan.
  };
  struct Lag {
    VelocityMoments moments;
    double delay_s = 0.0;  // Sum over the velocities.

    void add(const Eigen::Vector2d& expected_mps, const Own& own, double by_s);
  };
  using Lags = std::array<Lag, kLags>;
  struct Candidates;

  [[nodiscard]] Past& past(std::size_t motions_ago) {
    return past_[(motions_ - 1 - motions_ago) % past_.size()];
  }
  [[nodiscard]] static bool is_complete(const Lags& lags);
  [[nodiscard]] double chi_square_if_healthy(const VelocityMoments& moments) const;
  void add_leads();
  /// `at_once`: without delay.
  void try_late(Candidates& candidates, const VelocityMoments& at_once, const Lags& lags) const;
  void try_mount_yaw(Candidates& candidates) const;
  [[nodiscard]] FaultCause exchanged_with(RadarSet radars) const;
  [[nodiscard]] bool explains(double chi_square) const;
  [[nodiscard]] double gain(double healthy, double chi_square) const;

  std::span<const Pose2> mounts_;
  std::size_t radar_;
  bool looks_across_;
  std::array<Past, kLags + 1> past_;
  std::size_t motions_ = 0;
  Eigen::Vector3d motion_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d motion_covariance_ = Eigen::Matrix3d::Zero();
  std::vector<VelocityMoments> at_mount_;  // Of this radar at the mount of each.
  Lags lags_;                              // Of this radar with earlier velocities by the others.
  // Of this radar kLags motions ago, with the velocities by the others then, and since.
  VelocityMoments before_;
  Lags leads_;
  double chance_ = 0.0;
};

}  // namespace cremed
