// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "cremed/can_decoders/vehicle_reading.hpp"
#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/fusion/state/odometry_options.hpp"

namespace cremed {

/// What is wrong with a signal of the vehicle's bus: h offset, g scale and tau delay by least
/// squares. They are a fault if they differ from 0 by more than their uncertainty and the errors of
/// healthy sensors and radars explain. The three are tested together, since on a straight road
/// offset and scale cannot be told apart. Two kinds of evidence are judged each by itself:
///
/// - The radars' own motions from scan to scan of the last minute. Unlike the filter these do not
///   follow a wrong yaw rate. Over a motion of rate w (a speed or yaw rate) and its change c, the
///   mean of the readings errs by z - w = h + g z - tau c + noise.
/// - The filter's innovations, if its state follows such an error (GaussianState): maps know the
///   yaw ten times as well as motions from scan to scan do.
class SignalCheck {
 public:
  SignalCheck(VehicleSignal signal, const VehicleOptions& options);

  /// A reading, in the order of the stamps; otherwise the earlier ones are discarded.
  void add(std::int64_t stamp_us, double value);
  /// Discards the readings, not the findings.
  void clear() { count_ = 0; }
  /// To be called when the clock of the stamps was set.
  void leave_clock() {
    clear();
    compared_us_ = 0;
  }
  /// What the filter's innovations tell of the errors (GaussianState).
  void take(const Eigen::Matrix3d& information, const Eigen::Vector3d& weighted);
  /// Mean rate of a radar's motion from `start_us` to `end_us`, with its variance.
  void compare(std::int64_t start_us, std::int64_t end_us, double rate, double variance);

  struct Errors {
    Eigen::Vector3d value;  ///< h, g, tau
    Eigen::Matrix3d covariance;
  };
  /// Zero and wide before the first comparisons.
  [[nodiscard]] Errors errors_by_radars() const { return errors_by(minute_); }
  /// By what was last taken.
  [[nodiscard]] Errors errors_by_filter() const { return errors_by(filter_); }
  /// Standard deviations of the errors that sensors and radars have anyway.
  [[nodiscard]] const Eigen::Vector3d& tolerance() const { return tolerance_; }
  /// The filter shows no sign of a fault.
  [[nodiscard]] bool is_clear_by_filter() const;
  /// By how much the uncertainty of each error exceeds what sensors and radars have anyway: 0 for
  /// one that is known to be right.
  [[nodiscard]] Eigen::Vector3d unverified_std() const;
  struct Finding {
    SignalFault fault = SignalFault::none;  ///< The largest of the errors, in sigmas.
    Errors errors;                          ///< By the evidence that shows it.
  };
  [[nodiscard]] Finding find() const;
  /// The radars' motions alone show a fault.
  [[nodiscard]] bool is_refuted_by_radars() const { return fault_by(minute_).has_value(); }
  [[nodiscard]] SignalFault fault() const { return find().fault; }

 private:
  /// At 100 Hz more than the time of a motion (max_gap_s) and its delay.
  static constexpr std::size_t kCapacity = 128;
  struct Sum {
    std::int64_t utime_us = 0;
    double value = 0.0;     ///< The reading.
    double integral = 0.0;  ///< Over all readings until this one.
  };

  struct Evidence {
    Eigen::Matrix3d information;
    Eigen::Vector3d weighted = Eigen::Vector3d::Zero();  // Information times the errors.
  };

  [[nodiscard]] static Errors errors_by(const Evidence& evidence);
  [[nodiscard]] double chi_square_by(const Evidence& evidence) const;
  [[nodiscard]] std::optional<Finding> fault_by(const Evidence& evidence) const;
  [[nodiscard]] std::optional<Sum> at(std::int64_t utime_us) const;
  [[nodiscard]] const Sum& sum(std::size_t i) const { return sums_[(first_ + i) % kCapacity]; }

  OrnsteinUhlenbeck radar_error_;
  std::int64_t delay_us_;
  Eigen::Vector3d tolerance_;
  std::array<Sum, kCapacity> sums_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  Eigen::Matrix3d prior_;  // Information of the prior.
  Evidence minute_;
  Evidence filter_;
  std::int64_t compared_us_ = 0;
};

}  // namespace cremed
