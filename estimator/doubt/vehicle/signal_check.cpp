// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/signal_check.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "cremed/estimator/scan/squared.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

/// Comparisons lose their weight over this time: some turns of a drive in town.
constexpr double kMinuteS = 60.0;
/// Prior of the errors: wide enough for any wrong unit. A speed has no offset, which could hardly
/// be told from a scale.
constexpr double kScalePriorStd = 1.0;
constexpr double kDelayPriorS = 1.0;
constexpr double kYawRateOffsetPriorRadps = 0.3;
constexpr double kSpeedOffsetPriorMps = 0.01;
/// Turns of an ARS408 are registered too small by up to 4 %, 2 % RMS.
constexpr double kTurnScaleStd = 0.02;
/// Speed by Doppler: its scale, and targets above the road.
constexpr double kSpeedScaleStd = 0.005;
/// What lasts of a radar's yaw rate in a drive: 0.0001 rad/m at 15 m/s.
constexpr double kYawRateOffsetStdRadps = 0.0015;
/// Chi-square of three errors, false-alarm rate as of 3 sigma of one.
constexpr double kMaxChiSquare = 14.2;
/// Below it there is no sign of a fault: a chi-square of three is larger by chance in 26 %.
constexpr double kClearChiSquare = 4.0;
/// Error of a radar's motions that lasts for seconds: on straights its yaw walks by 0.1 to 0.35
/// degrees each second (nuScenes). Without this noise it is taken for a scale of the signal where
/// the vehicle hardly turns: 17 +- 5 % on 0103.
constexpr OrnsteinUhlenbeck kYawRateError{0.005, 2.0};
constexpr OrnsteinUhlenbeck kSpeedError{0.05, 0.5};
/// Stamps of a radar, and the lead of its positions.
constexpr double kRadarDelayStdS = 0.02;
/// Beyond this a motion is an outlier, with a weight that falls with its error (Huber).
constexpr double kOutlierSigmas = 3.0;
/// Scans of several radars at one time count as this far apart.
constexpr double kShortestIntervalS = 0.01;

const OrnsteinUhlenbeck& radar_error(VehicleSignal signal) {
  return signal == VehicleSignal::speed ? kSpeedError : kYawRateError;
}

Eigen::Vector3d tolerance_of(VehicleSignal signal, const VehicleOptions& options) {
  const bool is_speed = signal == VehicleSignal::speed;
  return {is_speed ? kSpeedError.std
                   : std::hypot(kYawRateOffsetStdRadps, options.yaw_rate_bias_std_radps),
          std::hypot(is_speed ? kSpeedScaleStd : kTurnScaleStd, options.of(signal).scale_std),
          std::hypot(kRadarDelayStdS, options.delay_std_s)};
}

Eigen::Matrix3d prior_of(VehicleSignal signal) {
  const double offset_std =
      signal == VehicleSignal::speed ? kSpeedOffsetPriorMps : kYawRateOffsetPriorRadps;
  return Eigen::Vector3d(offset_std, kScalePriorStd, kDelayPriorS)
      .cwiseAbs2()
      .cwiseInverse()
      .asDiagonal();
}

}  // namespace

SignalCheck::SignalCheck(VehicleSignal signal, const VehicleOptions& options)
    : radar_error_(radar_error(signal)),
      delay_us_(std::llround(options.of(signal).delay_s * 1e6)),
      tolerance_(tolerance_of(signal, options)),
      prior_(prior_of(signal)),
      minute_{prior_},
      filter_{prior_} {}

void SignalCheck::add(std::int64_t stamp_us, double value) {
  const std::int64_t utime_us = stamp_us - delay_us_;
  if (count_ > 0 && utime_us <= sum(count_ - 1).utime_us) {
    clear();
  }
  double integral = 0.0;
  if (count_ > 0) {
    const Sum& last = sum(count_ - 1);
    integral =
        last.integral + 0.5 * (last.value + value) * seconds_between(last.utime_us, utime_us);
  }
  if (count_ == kCapacity) {
    first_ = (first_ + 1) % kCapacity;
    --count_;
  }
  sums_[(first_ + count_) % kCapacity] = {utime_us, value, integral};
  ++count_;
}

/// Value and integral at a time between two readings.
std::optional<SignalCheck::Sum> SignalCheck::at(std::int64_t utime_us) const {
  for (std::size_t i = 1; i < count_; ++i) {
    const Sum& a = sum(i - 1);
    const Sum& b = sum(i);
    if (a.utime_us <= utime_us && utime_us <= b.utime_us) {
      const double part_s = seconds_between(a.utime_us, utime_us);
      const double value =
          a.value + (b.value - a.value) * part_s / seconds_between(a.utime_us, b.utime_us);
      return Sum{utime_us, value, a.integral + 0.5 * (a.value + value) * part_s};
    }
  }
  return std::nullopt;
}

void SignalCheck::take(const Eigen::Matrix3d& information, const Eigen::Vector3d& weighted) {
  filter_ = {prior_ + information, weighted};
}

bool SignalCheck::is_clear_by_filter() const { return chi_square_by(filter_) < kClearChiSquare; }

SignalCheck::Errors SignalCheck::errors_by(const Evidence& evidence) {
  const Eigen::Matrix3d covariance = evidence.information.inverse();
  return {covariance * evidence.weighted, covariance};
}

/// Of the errors, beyond those that sensors and radars have anyway.
double SignalCheck::chi_square_by(const Evidence& evidence) const {
  Errors errors = errors_by(evidence);
  errors.covariance.diagonal() += tolerance_.cwiseAbs2();
  return errors.value.dot(errors.covariance.inverse() * errors.value);
}

void SignalCheck::compare(std::int64_t start_us, std::int64_t end_us, double rate,
                          double variance) {
  const auto start = at(start_us);
  const auto end = at(end_us);
  if (!start || !end || start_us >= end_us) {
    return;
  }
  const double duration_s = seconds_between(start_us, end_us);
  const double mean = (end->integral - start->integral) / duration_s;
  const Eigen::Vector3d by(1.0, mean, -(end->value - start->value) / duration_s);
  const double passed_s = compared_us_ == 0 ? duration_s : seconds_between(compared_us_, end_us);
  compared_us_ = std::max(compared_us_, end_us);
  // Spread over the comparisons, as in VehicleMeasurement.
  const double interval_s = std::max(std::min(passed_s, duration_s), kShortestIntervalS);
  const double std = std::sqrt(
      variance + squared(radar_error_.std) * std::max(1.0, 2.0 * radar_error_.time_s / interval_s));
  const double difference = mean - rate;
  const double error = std::abs(difference - by.dot(errors_by_radars().value)) / std;
  const double weight = std::min(1.0, kOutlierSigmas / std::max(error, 1e-9)) / squared(std);
  const double kept = std::exp(-std::max(passed_s, 0.0) / kMinuteS);
  minute_.information =
      prior_ + kept * (minute_.information - prior_) + weight * by * by.transpose();
  minute_.weighted = kept * minute_.weighted + weight * difference * by;
}

Eigen::Vector3d SignalCheck::unverified_std() const {
  return (errors_by_radars().covariance.diagonal().cwiseSqrt() - tolerance_).cwiseMax(0.0);
}

SignalCheck::Finding SignalCheck::find() const {
  for (const Evidence* evidence : {&minute_, &filter_}) {
    if (const auto fault = fault_by(*evidence)) {
      return *fault;
    }
  }
  return {SignalFault::none, errors_by_radars()};
}

std::optional<SignalCheck::Finding> SignalCheck::fault_by(const Evidence& evidence) const {
  if (chi_square_by(evidence) <= kMaxChiSquare) {
    return std::nullopt;
  }
  const Errors errors = errors_by(evidence);
  const Eigen::Vector3d variance = errors.covariance.diagonal() + tolerance_.cwiseAbs2();
  Eigen::Index largest = 0;
  errors.value.cwiseAbs2().cwiseQuotient(variance).maxCoeff(&largest);
  constexpr std::array<SignalFault, 3> kFaults{SignalFault::offset, SignalFault::scale,
                                               SignalFault::delay};
  return Finding{kFaults[static_cast<std::size_t>(largest)], errors};
}

}  // namespace cremed
