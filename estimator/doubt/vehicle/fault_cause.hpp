// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/scan/pose2.hpp"

namespace cremed {

/// Which systematic error explains the velocities by Doppler of a radar that is at fault.
///
/// With the velocity m of the sensor by its Doppler and e by the other radars, both in the sensor's
/// frame and as complex numbers, the sums of |e - f(m)|^2 are compared: f(m) = k m (scale), -m
/// (sign), m exp(i a) (mount yaw), conj(m) (upside down), m + w d
/// across the vehicle (mount x); e at an earlier time (late), or at the
/// mount of another radar (exchanged). A cause is named if it alone explains them. Data that fit
/// the mount of another radar at fault are taken for exchanged, whatever else would explain them.
class FaultCauseSearch {
 public:
  /// `mounts` of all radars, which must outlive this object.
  FaultCauseSearch(std::span<const Pose2> mounts, std::size_t radar);

  /// The motion by the other radars, x = (v, w, slip); seven times a second.
  void add_motion(std::int64_t time_us, const Eigen::Vector3d& motion);
  /// The radar's velocity at the time of the last motion, in the axes of the vehicle.
  void add_velocity(const Eigen::Vector2d& velocity_mps);
  /// Starts again: its fault has ended.
  void clear();
  /// To be called when the clock of the stamps was set.
  void forget();

  /// `at_fault`: all radars that are, a bit each. One that was exchanged with this is among them.
  [[nodiscard]] FaultCause cause(std::uint32_t at_fault) const;

 private:
  using Complex = std::complex<double>;
  static constexpr std::size_t kLags = 6;

  /// Sums of m and e with weights.
  struct Products {
    double expected = 0.0;  // |e|^2
    Complex product = 0.0;  // e conj(m)

    void add(const Complex& e, const Complex& m, double weight);
    void fade();
  };
  struct Past {
    std::int64_t time_us = 0;
    Complex velocity_mps;
  };
  struct Lag {
    double squares = 0.0;
    double count = 0.0;
    double delay_s = 0.0;  // Sum.
  };
  struct Best;

  [[nodiscard]] Complex expected(const Eigen::Vector3d& motion, const Pose2& mount) const;
  [[nodiscard]] double cost(const Products& products) const;
  [[nodiscard]] std::optional<FaultCause> exchanged(std::uint32_t at_fault) const;
  void try_late(Best& best) const;

  std::span<const Pose2> mounts_;
  std::size_t radar_;
  std::array<Past, kLags + 1> past_;
  std::size_t motions_ = 0;
  Eigen::Vector3d motion_ = Eigen::Vector3d::Zero();
  double count_ = 0.0;     // Of velocities, faded.
  double measured_ = 0.0;  // |m|^2
  // Of e - m across the vehicle with the yaw rate, and of that.
  double across_ = 0.0;
  double turn_ = 0.0;
  Complex mirrored_ = 0.0;          // e m
  std::vector<Products> at_mount_;  // By radar whose mount it is.
  std::array<Lag, kLags> lags_;
};

}  // namespace cremed
