// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/filter_condition.hpp"

#include <bit>
#include <cmath>

#include "cremed/estimator/scan/gate.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

using namespace state_layout;

/// Above this sigma a scan's Doppler sets the speed without a gate: max_doppler_nis would accept
/// errors of 4 m/s and more, a usual speed of other cars relative to the vehicle.
constexpr double kUnknownSpeedStdMps = 1.0;
/// After a scan that shows two worlds, what seems to rest may be cars that drive along and hide the
/// road. Wrong poses in simulated jams with few radars: 10 to 50 % with 2 s, up to 10 % with 3.5 s,
/// fewer with 5 s.
constexpr double kHiddenRoadS = 5.0;
/// Above the noise of a start at rest, and below what cars in a jam differ by.
constexpr double kAtRestMps = 0.3;
/// Half a second of two radars. Among cars that drive alike some scans in between show only these.
constexpr int kMaxDoubts = 10;

bool stands(const Odometry& odometry, double standstill_mps) {
  const auto std = [&](int i) { return std::sqrt(odometry.twist_covariance(i, i)); };
  return std::abs(odometry.twist.x()) <= standstill_mps && std(0) <= standstill_mps &&
         std::abs(odometry.twist.z()) <= kGateSigmas * std(2);
}

}  // namespace

void FilterCondition::start() {
  is_settled_ = false;
  used_scans_ = 0;
  used_us_ = clear_us_ = state_.time_us();
  doubt_us_ = std::min(doubt_us_, state_.time_us());  // The clock may have been set.
}

void FilterCondition::doubt() {
  doubt_us_ = state_.time_us();
  doubts_ = std::min(doubts_ + 1, kMaxDoubts);
}

void FilterCondition::unsettle() {
  is_settled_ = false;
  doubt();
}

void FilterCondition::use_scan(bool is_clear) {
  if (is_lost() && doubts_ > 0) {
    start();  // Lost among traffic, not by silence: one clear scan is not the end.
  }
  used_us_ = state_.time_us();
  clear_us_ = is_clear ? used_us_ : clear_us_;
  ++used_scans_;
  doubts_ = std::max(0, doubts_ - 1);
}

bool FilterCondition::settle() {
  const bool settles = !is_settled_ && is_known();
  is_settled_ = is_settled_ || settles;
  return settles;
}

bool FilterCondition::is_speed_unknown() const {
  return state_.gaussian.std(kSpeed) > kUnknownSpeedStdMps;
}

bool FilterCondition::is_known() const {
  const OdometryOptions& options = state_.options();
  return state_.gaussian.std(kSpeed) <= options.settled_speed_std_mps &&
         state_.gaussian.std(kYawRate) <= options.settled_yaw_rate_std_radps &&
         used_scans_ >= options.settled_scans && doubts_ == 0 && !may_drive_in_traffic() &&
         faults_.is_verified() &&
         std::popcount(consensus_.agreeing(used_us_)) >
             std::popcount(consensus_.contradicting(used_us_));
}

bool FilterCondition::may_drive_in_traffic() const {
  return std::abs(state_.gaussian.mean(kSpeed)) <= kAtRestMps &&
         seconds_between(doubt_us_, state_.time_us()) <= kHiddenRoadS;
}

bool FilterCondition::is_lost() const {
  return unused_s(state_.time_us()) > state_.options().lost_s;
}

double FilterCondition::unused_s(std::int64_t at_us) const {
  return seconds_between(used_us_, at_us);
}

bool FilterCondition::is_doubtful(std::int64_t at_us) const {
  return seconds_between(doubt_us_, at_us) <= kScanVerdictValidS;
}

OdometryStatus FilterCondition::status(const Odometry& odometry) const {
  const OdometryOptions& options = state_.options();
  const bool is_predicted = unused_s(odometry.utime_us) > options.predicted_s;
  if (is_doubtful(odometry.utime_us) && (!is_settled_ || is_predicted)) {
    return OdometryStatus::ambiguous;
  }
  if (unused_s(odometry.utime_us) > options.lost_s) {
    return OdometryStatus::lost;
  }
  if (!is_settled_) {
    return consensus_.contradicting(state_.time_us()) != 0 ? OdometryStatus::ambiguous
                                                           : OdometryStatus::initialising;
  }
  if (is_predicted) {
    return OdometryStatus::predicted;
  }
  if (seconds_between(clear_us_, odometry.utime_us) > options.ambiguous_s) {
    return OdometryStatus::ambiguous;
  }
  return stands(odometry, options.standstill_mps) ? OdometryStatus::standing_still
                                                  : OdometryStatus::ok;
}

}  // namespace cremed
