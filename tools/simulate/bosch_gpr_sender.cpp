// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulate/bosch_gpr_sender.hpp"

#include <cmath>

#include "tools/simulate/bosch_gpr_encoder.hpp"

namespace cremed {
namespace {

/// Field of view and resolution of this radar are not published; these are typical ones.
constexpr RadarCharacter kCharacter{.zones = {{{0.35, 120.0}, {0.8, 70.0}, {1.05, 30.0}}},
                                    .least_range_m = 1.0,
                                    .range_resolution_m = 0.5,
                                    .azimuth_resolution_rad = 0.07,
                                    .doppler_resolution_mps = 0.2,
                                    .mean_ghosts = 2};

constexpr ScanCycle kCycle{99'000, 101'000};

// The radar's accuracy before it is rounded up to reportable values.
constexpr double kRangeStdM = 0.15;
constexpr double kRangeStdPerMetre = 0.002;
constexpr double kAzimuthStdRad = 0.0105;
constexpr double kDopplerStdMps = 0.12;

/// The smallest multiple of `step` not below the standard deviation.
double reported(double std, double step) { return std::ceil(std / step) * step; }

/// The reported quality of a target here. An antenna's angular accuracy decreases off its axis.
PolarStd reported_std(const RadarView& view) {
  return {reported(std::hypot(kRangeStdM, kRangeStdPerMetre * view.range_m), kGprRangeStepM),
          reported(kAzimuthStdRad / std::cos(view.azimuth_rad), kGprAzimuthStdStepRad),
          reported(kDopplerStdMps, kGprDopplerStepMps)};
}

/// Noise to draw, so that with the rounding to `step` the error is the reported one.
double without_rounding(double std, double step) {
  return std::sqrt(std * std - step * step / 12.0);
}

}  // namespace

BoschGprSender::BoschGprSender(const BoschGprOptions& options, const Scene& scene,
                               const SenderSetup& setup)
    : RadarSender(kCharacter, kCycle, encode_bosch_gpr(options.base_id, BoschGprTargetA{}), scene,
                  setup),
      options_(options) {}

PolarStd BoschGprSender::noise(const RadarView& view) const {
  const PolarStd std = reported_std(view);
  return {without_rounding(std.range_m, kGprRangeStepM),
          without_rounding(std.azimuth_rad, kGprAzimuthStepRad),
          without_rounding(std.doppler_mps, kGprDopplerStepMps)};
}

BoschGprTargetA BoschGprSender::target_a(const Measurement& measurement) const {
  BoschGprTargetA target;
  target.range_m = measurement.range_m;
  target.azimuth_rad = measurement.azimuth_rad * (options_.invert_azimuth ? -1.0 : 1.0);
  target.radial_velocity_mps = measurement.doppler_mps * (options_.invert_doppler ? -1.0 : 1.0);
  target.power_dbm2 = measurement.echo.rcs_dbm2;
  target.measured = true;
  return target;
}

BoschGprTargetB BoschGprSender::target_b(const Measurement& measurement) {
  const PolarStd std = reported_std(measurement.echo.view);
  BoschGprTargetB target;
  target.azimuth_std_rad = std.azimuth_rad;
  target.radial_velocity_std_mps = std.doppler_mps;
  target.range_std_m = std.range_m;
  target.existence = measurement.echo.kind == EchoKind::ghost ? random().uniform(0.2, 0.5)
                                                              : random().uniform(0.75, 0.95);
  return target;
}

void BoschGprSender::encode(const std::vector<Measurement>& targets, std::uint32_t cycle,
                            std::vector<CanFrame>& list) {
  const auto counter = static_cast<std::uint8_t>(cycle % 4U);
  for (std::uint8_t slot = 0; slot < kBoschGprSlots; ++slot) {
    BoschGprTargetA a;
    BoschGprTargetB b;
    if (slot < targets.size()) {
      a = target_a(targets[slot]);
      b = target_b(targets[slot]);
    }
    a.id = b.id = slot;
    a.counter = b.counter = counter;
    list.push_back(encode_bosch_gpr(options_.base_id, a));
    list.push_back(encode_bosch_gpr(options_.base_id, b));
  }
}

void BoschGprSender::finish(CanFrame& frame, std::int64_t age_us) {
  const bool is_b = ((frame.id - options_.base_id) & 1U) != 0;
  if (is_b) set_bosch_gpr_age(frame, age_us);
}

}  // namespace cremed
