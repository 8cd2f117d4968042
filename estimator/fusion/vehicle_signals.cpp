// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/vehicle_signals.hpp"

#include <algorithm>
#include <cmath>

#include "cremed/estimator/fusion/measurement/vehicle_measurement.hpp"
#include "cremed/estimator/scan/gate.hpp"
#include "cremed/estimator/scan/squared.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

using namespace state_layout;

/// Changes that prove a standing signal frozen: several times the noise of any sensor of it. Wheels
/// show a crawling vehicle as standing.
constexpr double kFrozenSpeedMps = 0.5;
constexpr double kFrozenYawRateRadps = 0.02;
/// Of learned errors. Beyond it the factor or unit is wrong.
constexpr double kMaxErrorSigmas = 4.0;
/// So long the filter looks for a fault that began at one time: a manoeuvre in which it shows; if
/// there is a sign of one, several.
constexpr double kFaultS = 5.0;
constexpr double kLongestFaultS = 30.0;

double frozen_change(VehicleSignal signal) {
  return signal == VehicleSignal::speed ? kFrozenSpeedMps : kFrozenYawRateRadps;
}

}  // namespace

VehicleSignals::Source::Source(VehicleSignal which, const VehicleOptions& options)
    : signal(which),
      track(options.period_s, options.of(which).delay_s),
      standing(frozen_change(which)),
      check(which, options) {}

VehicleSignals::VehicleSignals(OdometryState& state, OdometryOutput& output)
    : state_(state),
      output_(output),
      sources_{Source(VehicleSignal::speed, state.options().vehicle),
               Source(VehicleSignal::yaw_rate, state.options().vehicle)} {}

bool VehicleSignals::is_used(VehicleSignal signal) const {
  return state_.options().vehicle.of(signal).is_used;
}

void VehicleSignals::add(const VehicleReading& reading) {
  if (!is_used(reading.signal)) {
    return;
  }
  Source& source = sources_[static_cast<std::size_t>(reading.signal)];
  ++source.readings;
  source.heard_us = reading.stamp_us;
  source.standing.add(reading.stamp_us, reading.value);
  // A value that repeats for 0.2 s tells nothing new. At standstill that is no fault.
  if (source.standing.is_standing()) {
    source.track.clear();
    source.check.clear();
  } else {
    source.check.add(reading.stamp_us, reading.value);
    source.track.add(reading.stamp_us, reading.value);
  }
}

void VehicleSignals::forget() {
  for (Source& source : sources_) {
    source.track.clear();
    source.standing.clear();
    source.check.leave_clock();
    source.heard_us.reset();
    source.compared_us.reset();
  }
}

void VehicleSignals::restart_errors() {
  for (Source& source : sources_) {
    if (is_used(source.signal)) {
      state_.start_signal(source.signal);
    }
  }
}

void VehicleSignals::compare(const Pose2& mount, const EgoMotion& motion) {
  // The covariance of the motions of a radar that looks sideways is too small.
  if (!motion.has_estimate() || looks_across(mount)) {
    return;
  }
  const double duration_s = seconds_between(motion.utime_start_us, motion.utime_us);
  const auto compare = [&](VehicleSignal signal, int axis) {
    sources_[static_cast<std::size_t>(signal)].check.compare(
        motion.utime_start_us, motion.utime_us, motion.motion(axis) / duration_s,
        motion.covariance(axis, axis) / squared(duration_s));
  };
  compare(VehicleSignal::speed, 0);
  compare(VehicleSignal::yaw_rate, 2);
}

void VehicleSignals::note_lost(std::int64_t stamp_us) {
  const double lost_s = state_.options().vehicle.lost_s;
  for (Source& source : sources_) {
    if (is_used(source.signal)) {
      source.heard_us = source.heard_us.value_or(stamp_us);
      source.lost.update(seconds_between(*source.heard_us, stamp_us) > lost_s);
    }
  }
}

bool VehicleSignals::use_until(std::int64_t stamp_us, bool is_known) {
  note_lost(stamp_us);
  for (Source& source : sources_) {
    if (is_used(source.signal)) {
      watch(source, is_known);
      look_anew(source);
    }
  }
  bool is_one_wrong = false;
  for (Source* source = earliest(); source != nullptr; source = earliest()) {
    const SignalTrack::Value value = *source->track.front();
    if (value.utime_us > stamp_us) {
      break;
    }
    source->track.pop();
    if (is_known) {
      is_one_wrong = use(*source, value) || is_one_wrong;
    }
  }
  return is_one_wrong;
}

/// Looks for a fault that begins now, if there is no sign of an earlier one.
void VehicleSignals::look_anew(const Source& source) {
  const double since_s =
      seconds_between(state_.fault_evidence(source.signal).since_us, state_.time_us());
  if (since_s > (source.check.is_clear_by_filter() ? kFaultS : kLongestFaultS)) {
    state_.forget_faults(source.signal);
  }
}

/// Notes whether the signal is frozen.
void VehicleSignals::watch(Source& source, bool is_known) {
  const int rate = rate_of(source.signal);
  if (is_known) {
    source.standing.expect(state_.gaussian.mean(rate), kGateSigmas * state_.gaussian.std(rate));
  }
  source.frozen.update(source.standing.is_frozen());
}

/// The signal with the earliest value; null if there is none.
VehicleSignals::Source* VehicleSignals::earliest() {
  Source* first = nullptr;
  for (Source& source : sources_) {
    const auto value = source.track.front();
    if (value && (first == nullptr || value->utime_us < first->track.front()->utime_us)) {
      first = &source;
    }
  }
  return first;
}

/// True if the signal is found wrong by it.
bool VehicleSignals::use(Source& source, const SignalTrack::Value& value) {
  output_.advance_to(value.utime_us);
  const OdometryOptions& options = state_.options();
  const double age_s = seconds_between(value.utime_us, state_.time_us());
  const double longest_s = 2.0 * options.vehicle.of(source.signal).error.time_s;
  const double interval_s =
      source.compared_us ? seconds_between(*source.compared_us, value.utime_us) : longest_s;
  if (age_s > options.max_lateness_s || interval_s <= 0.0) {
    return false;
  }
  state_.advance_signal(source.signal, interval_s);
  source.compared_us = value.utime_us;
  LinearMeasurement measurement =
      VehicleMeasurement{state_, source.signal, age_s, std::min(interval_s, longest_s)}.linearise(
          value.value);
  measurement.noise(0, 0) *= source.noise.value();
  measurement.noise(0, 0) += unverified_variance(source, value.value);
  const Innovation innovation = state_.gaussian.innovate(measurement);
  source.nis.add(value.utime_us, innovation.nis);
  return judge(source, innovation);
}

/// Noise for a scale and delay that the radars have not yet seen to be right. Without it a yaw rate
/// with the wrong sign, which agrees on a straight road, leads the filter astray in the first turn,
/// since its noise is far smaller than the radars'.
double VehicleSignals::unverified_variance(const Source& source, double value) const {
  const Eigen::Vector3d unverified = source.check.unverified_std();
  const double change = state_.gaussian.mean(rate_of(source.signal) + 1);
  return squared(value * unverified(1)) + squared(change * unverified(2));
}

/// Updates the state if the signal is trusted. True if it is no longer.
bool VehicleSignals::judge(Source& source, const Innovation& innovation) {
  const bool was_left_out = source.trust.is_left_out();
  const bool is_expected = innovation.nis <= state_.options().vehicle.max_nis &&
                           !(was_left_out && source.check.is_refuted_by_radars());
  source.trust.judge(is_expected);
  if (was_left_out) {
    return false;
  }
  if (!source.trust.is_left_out()) {
    source.noise.add(innovation.nis);
    if (is_expected) {
      state_.update(innovation);
      ++source.used;
    }
    const OdometryState::FaultEvidence& evidence = state_.fault_evidence(source.signal);
    source.check.take(evidence.information, evidence.weighted);
    if (!has_credible_errors(source) || source.check.fault() != SignalFault::none) {
      source.trust.leave_out();
    }
  }
  if (source.trust.is_left_out()) {
    leave_out(source);
  }
  return source.trust.is_left_out();
}

/// Corrects the state by what it followed. What was found stays for the report.
void VehicleSignals::leave_out(Source& source) {
  const SignalCheck::Finding found = source.check.find();
  const SignalCheck::Errors errors =
      found.fault == SignalFault::none ? source.check.errors_by_filter() : found.errors;
  state_.correct_fault(source.signal, errors.value, errors.covariance);
  state_.start_signal(source.signal);
  source.noise.clear();
}

/// Whether sensors and radars may have the learned errors of a signal.
bool VehicleSignals::has_credible_errors(const Source& source) const {
  const Eigen::Vector3d& tolerance = source.check.tolerance();
  const auto is_within = [&](int error, double std) {
    return std::abs(state_.gaussian.mean(state_.vehicle_error(error))) <= kMaxErrorSigmas * std;
  };
  return is_within(scale_of(source.signal), tolerance(1)) &&
         (source.signal == VehicleSignal::speed || is_within(kYawRateBias, tolerance(0)));
}

VehicleSignalReport VehicleSignals::report(VehicleSignal signal) const {
  VehicleSignalReport report;
  report.is_used = is_used(signal);
  if (!report.is_used) {
    return report;
  }
  const Source& source = sources_[static_cast<std::size_t>(signal)];
  const GaussianState& state = state_.gaussian;
  const int scale = state_.vehicle_error(scale_of(signal));
  report.is_lost = source.lost.is_present;
  report.is_frozen = source.frozen.is_present;
  report.is_left_out = source.trust.is_left_out();
  report.times_lost = source.lost.times;
  report.times_frozen = source.frozen.times;
  report.times_left_out = source.trust.times_left_out();
  report.readings = source.readings;
  report.measurements_used = source.used;
  report.nis = source.nis.mean();
  report.scale = state.mean(scale);
  report.scale_std = state.std(scale);
  if (signal == VehicleSignal::yaw_rate) {
    const int bias = state_.vehicle_error(kYawRateBias);
    report.bias_radps = state.mean(bias);
    report.bias_std_radps = state.std(bias);
  }
  const SignalCheck::Finding found = source.check.find();
  report.fault = found.fault;
  report.seen_offset = found.errors.value(0);
  report.seen_scale = found.errors.value(1);
  report.seen_delay_s = found.errors.value(2);
  return report;
}

}  // namespace cremed
