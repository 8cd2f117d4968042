// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/calibrate/sensor_noise.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "tools/eval/calibrate/matched_targets.hpp"
#include "tools/eval/calibrate/matched_turns.hpp"
#include "tools/eval/calibrate/sensor_velocity.hpp"

namespace cremed {
namespace {

constexpr std::size_t kMinTargetsOfNoise = 12;  // In a scan whose Doppler is compared.

constexpr double kLeastFactorStd = 0.03;  // Targets differ; one drive does not contain all kinds.

StdFactor of_any_drive(const StdFactor& factor) {
  return {factor.value, factor.std > 0.0 ? std::hypot(factor.std, kLeastFactorStd) : 0.0};
}

double at_least_one(const StdFactor& factor) { return std::max(factor.value, 1.0); }

MatchErrors match_errors(const std::vector<RecordedScan>& scans, const CalibrationFit& fit,
                         std::size_t radar, const AssumedFactors& assumed) {
  MatchErrors errors;
  for (std::size_t i = 1; i < scans.size(); ++i) {
    const auto motion = radar_motion(fit, radar, scans[i - 1].stamp_us, scans[i].stamp_us);
    if (motion) {
      add_match_errors(scans[i - 1], scans[i], *motion, assumed, errors);
    }
  }
  return errors;
}

/// The state that fits one scan best; one scan determines the rotation lead too poorly to fit it.
constexpr int kFitted = kDopplerStates - 1;
DopplerState nearest_state(const DopplerEquations& equations, const DopplerState& expected) {
  DopplerState state = expected;
  state.head<kFitted>() = equations.root.leftCols<kFitted>().fullPivHouseholderQr().solve(
      equations.measured - equations.root.col(kFitted) * expected[kFitted]);
  return state;
}

/// Of one scan; `noise` is assumed.
void add_doppler_errors(const RecordedScan& scan, const DopplerState& expected,
                        const DopplerNoise& noise, std::vector<ScaledError>& errors) {
  const double gate = noise.doppler_std_factor * kErrorGate / kGateSigma;
  const RecordedScan fixed = static_part(scan, expected, {gate, gate, 0.0, 0.0});
  if (fixed.targets.size() < kMinTargetsOfNoise) {
    return;
  }
  const DopplerState state = nearest_state(doppler_equations(fixed, expected, noise), expected);
  const auto count = static_cast<double>(fixed.targets.size());
  const double lost = std::sqrt(count / (count - kFitted));
  for (const Target& target : fixed.targets) {
    const double std_mps = noise.doppler_std_factor * target.doppler_std_mps;
    const double by_azimuth =
        noise.azimuth_std_factor * doppler_std_by_azimuth_mps(target, expected) / std_mps;
    const double error_mps =
        target.doppler_mps - doppler_row(target, expected, scan.told_yaw_rate_radps) * state;
    errors.push_back({scan.stamp_us, lost * error_mps / std_mps, by_azimuth * by_azimuth});
  }
}

}  // namespace

SensorNoise measured_noise(const std::vector<RecordedScan>& scans, const CalibrationFit& fit,
                           std::size_t radar, const SensorNoise& before) {
  const AssumedFactors assumed{at_least_one(before.range), at_least_one(before.azimuth)};
  const MatchErrors matches = match_errors(scans, fit, radar, assumed);
  SensorNoise result;
  result.range = of_any_drive(noise_factor(matches.range, assumed.range));
  result.azimuth = of_any_drive(noise_factor(matches.azimuth, assumed.azimuth));
  const DopplerNoise noise{at_least_one(before.doppler), result.azimuth.value, 0.0, 0.0};
  std::vector<ScaledError> errors;
  for (const RecordedScan& scan : scans) {
    if (const auto expected = fit.expected(radar, scan.stamp_us)) {
      add_doppler_errors(scan, *expected, noise, errors);
    }
  }
  result.doppler = of_any_drive(noise_factor(errors, noise.doppler_std_factor));
  return result;
}

}  // namespace cremed
