// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulate/ars408_sender.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "cremed/estimator/scan/degrees.hpp"
#include "tools/simulate/ars408_encoder.hpp"

namespace cremed {
namespace {

/// Beam and resolution of the near scan from the data sheet; also used for the far scan.
constexpr RadarCharacter kCharacter{
    .zones = {{{9.0 * kRadPerDeg, 200.0}, {45.0 * kRadPerDeg, 90.0}, {60.0 * kRadPerDeg, 20.0}}},
    .least_range_m = 1.0,
    .range_resolution_m = 0.42,
    .azimuth_resolution_rad = 3.2 * kRadPerDeg,
    .doppler_resolution_mps = 0.12,
    .mean_ghosts = 4};

/// Of an ARS404 only the range is known (kArs404MaxRangeM); the rest is that of an ARS408.
RadarCharacter character(Ars408Model model) {
  RadarCharacter character = kCharacter;
  if (model == Ars408Model::ars404_21) {
    for (BeamZone& zone : character.zones) {
      zone.range_m = std::min(zone.range_m, kArs404MaxRangeM);
    }
  }
  return character;
}

constexpr ScanCycle kCycle{72'000, 75'000};
constexpr std::uint32_t kCounterStep = 2;
constexpr std::uint8_t kInterfaceVersion = 1;
constexpr double kNearScanM = 70.0;

// The radar's accuracy before it is rounded up to codes.
constexpr double kRangeStdM = 0.2;
constexpr double kRangeStdPerMetre = 0.003;
constexpr double kAzimuthStdRad = 0.014;
constexpr double kDopplerStdMps = 0.28;
constexpr double kObjectVyStdMps = 0.45;

/// Lower bound: with less noise the grid of 0.2 m would show, and slow targets would keep the same
/// rounding error from scan to scan.
constexpr double kLeastPositionStdM = 0.135;

/// The hardware reports the same lateral code for all clusters: 0.011 m/s.
constexpr std::uint8_t kClusterVyCode = 3;

/// InvalidState codes, about as frequent as on the road.
using State = Ars408InvalidState;
constexpr std::array<State, 7> kDoubts{State::low_rcs,
                                       State::low_rcs,
                                       State::no_local_maximum,
                                       State::no_local_maximum,
                                       State::high_child_probability,
                                       State::high_child_probability,
                                       State::high_multi_target_probability};
constexpr double kDoubtShare = 0.35;

/// A target with less Doppler counts as standing.
constexpr double kStandingDopplerMps = 0.5;

/// A frame carries lateral velocities up to 64 m/s, which a turn of 0.5 rad/s exceeds at 130 m. The
/// real sensor's behaviour is unknown; here the target is not sent.
constexpr double kGreatestSpeedMps = 63.0;

double square(double value) { return value * value; }

/// Variance of a code of table R.
double variance(std::uint8_t code) { return square(ars408_std(code).value_or(0.0)); }

double rounding_variance(double step) { return step * step / 12.0; }

std::uint8_t position_code(double std_m) {
  return ars408_rms_code(std::max(std_m, kLeastPositionStdM));
}

/// A speed error that has the reported standard deviation after rounding to the grid.
double speed_noise_std(std::uint8_t code) {
  return std::sqrt(variance(code) - rounding_variance(kArs408SpeedStepMps));
}

}  // namespace

Ars408Sender::Ars408Sender(const Ars408Options& options, const Scene& scene,
                           const SenderSetup& setup)
    : RadarSender(character(options.model), kCycle,
                  options.output == Ars408Output::objects
                      ? encode_ars408(options.sensor_id, Ars408ObjectStatus{})
                      : encode_ars408(options.sensor_id, Ars408ClusterStatus{}),
                  scene, setup),
      options_(options) {}

double Ars408Sender::reported_azimuth_rad(double measured_rad) const {
  return measured_rad - setup().correction.rotation_lead_s * told().yaw_rate_radps;
}

double Ars408Sender::static_across(double range_m, double azimuth_rad) const {
  return static_across_mps(told(), setup().stated_mount, range_m, azimuth_rad);
}

/// In the reported direction, which the reader uses.
Ars408RmsCodes Ars408Sender::rms_codes(const RadarView& view) const {
  const double cos_azimuth = std::cos(reported_azimuth_rad(view));
  const double sin_azimuth = std::sin(reported_azimuth_rad(view));
  const double along_m = std::hypot(kRangeStdM, kRangeStdPerMetre * view.range_m);
  const double across_m = view.range_m * kAzimuthStdRad;
  Ars408RmsCodes codes;
  codes.x = position_code(std::hypot(cos_azimuth * along_m, sin_azimuth * across_m));
  codes.y = position_code(std::hypot(sin_azimuth * along_m, cos_azimuth * across_m));
  // A cluster's Doppler accuracy is reported in x only, as by the hardware.
  codes.vx = ars408_rms_code(sends_objects() ? kDopplerStdMps : kDopplerStdMps / cos_azimuth);
  codes.vy = sends_objects() ? ars408_rms_code(kObjectVyStdMps) : kClusterVyCode;
  return codes;
}

/// Reduces the noise to draw by the rounding errors: of x and y along and across the line of sight,
/// of both velocities on Doppler, and of the rounded line of sight, which turns a part of the
/// velocity across into Doppler.
PolarStd Ars408Sender::noise(const RadarView& view) const {
  const Ars408RmsCodes codes = rms_codes(view);
  const double azimuth_rad = reported_azimuth_rad(view);
  const double cos_2 = square(std::cos(azimuth_rad));
  const double sin_2 = square(std::sin(azimuth_rad));
  const double x_2 = variance(codes.x);
  const double y_2 = variance(codes.y);
  const double position_rounding = rounding_variance(kArs408DistanceStepM);
  const double doppler_2 = cos_2 * variance(codes.vx) + sin_2 * variance(codes.vy);
  PolarStd std;
  std.range_m = std::sqrt(cos_2 * x_2 + sin_2 * y_2 - position_rounding);
  std.azimuth_rad = std::sqrt(sin_2 * x_2 + cos_2 * y_2 - position_rounding) / view.range_m;
  const double across_mps = static_across(view.range_m, measured_azimuth_rad(view.azimuth_rad));
  const double doppler_rounding = rounding_variance(kArs408SpeedStepMps) +
                                  square(across_mps / view.range_m) * position_rounding;
  std.doppler_mps = std::sqrt(std::max(0.0, doppler_2 - doppler_rounding));
  return std;
}

bool Ars408Sender::can_report(const Measurement& measurement) const {
  const double across_mps = static_across(measurement.range_m, measurement.azimuth_rad);
  return std::hypot(measurement.doppler_mps, across_mps) < kGreatestSpeedMps;
}

void Ars408Sender::encode(const std::vector<Measurement>& targets, std::uint32_t cycle,
                          std::vector<CanFrame>& list) {
  const auto counter = static_cast<std::uint16_t>(kCounterStep * cycle);
  if (sends_objects()) {
    encode_objects(targets, counter, list);
  } else {
    encode_clusters(targets, counter, list);
  }
}

void Ars408Sender::encode_clusters(const std::vector<Measurement>& targets, std::uint16_t counter,
                                   std::vector<CanFrame>& list) {
  const auto near_count = std::ranges::count_if(
      targets, [](const Measurement& target) { return target.range_m < kNearScanM; });
  Ars408ClusterStatus status;
  status.near_count = static_cast<std::uint8_t>(near_count);
  status.far_count = static_cast<std::uint8_t>(targets.size() - status.near_count);
  status.counter = counter;
  status.interface_version = kInterfaceVersion;
  list.push_back(encode_ars408(options_.sensor_id, status));
  for (std::size_t i = 0; i < targets.size(); ++i) {
    Ars408General general = cluster(targets[i]);
    general.id = static_cast<std::uint8_t>(i);
    list.push_back(encode_ars408_cluster(options_.sensor_id, general));
  }
  for (std::size_t i = 0; i < targets.size(); ++i) {
    Ars408ClusterQuality quality = cluster_quality(rms_codes(targets[i].echo.view));
    quality.id = static_cast<std::uint8_t>(i);
    list.push_back(encode_ars408(options_.sensor_id, quality));
  }
}

void Ars408Sender::encode_objects(const std::vector<Measurement>& targets, std::uint16_t counter,
                                  std::vector<CanFrame>& list) {
  Ars408ObjectStatus status;
  status.count = static_cast<std::uint8_t>(targets.size());
  status.counter = counter;
  status.interface_version = kInterfaceVersion;
  list.push_back(encode_ars408(options_.sensor_id, status));
  for (std::size_t i = 0; i < targets.size(); ++i) {
    Ars408General general = object(targets[i], rms_codes(targets[i].echo.view));
    general.id = static_cast<std::uint8_t>(i);
    list.push_back(encode_ars408_object(options_.sensor_id, general));
  }
  for (std::size_t i = 0; i < targets.size(); ++i) {
    Ars408ObjectQuality quality;
    quality.id = static_cast<std::uint8_t>(i);
    quality.rms = rms_codes(targets[i].echo.view);
    quality.existence_code = targets[i].echo.kind == EchoKind::ghost ? 3 : 7;
    quality.measurement_state = Ars408MeasurementState::measured;
    list.push_back(encode_ars408(options_.sensor_id, quality));
  }
}

/// A target whose velocity has these components along and across the measured line of sight: the
/// sensor uses its measured azimuth for both, so azimuth errors do not enter Doppler.
Ars408General Ars408Sender::general(const Measurement& measurement, double doppler_mps,
                                    double across_mps) {
  const double azimuth_rad = measurement.azimuth_rad;
  const double reported_rad = reported_azimuth_rad(azimuth_rad);
  Ars408General target;
  target.x_m = measurement.range_m * std::cos(reported_rad);
  target.y_m = measurement.range_m * std::sin(reported_rad);
  target.vx_mps = doppler_mps * std::cos(azimuth_rad) - across_mps * std::sin(azimuth_rad);
  target.vy_mps = doppler_mps * std::sin(azimuth_rad) + across_mps * std::cos(azimuth_rad);
  target.rcs_dbm2 = measurement.echo.rcs_dbm2;
  target.dyn_prop = dyn_prop(measurement.echo);
  return target;
}

/// As the sensor is mounted.
Ars408General Ars408Sender::mounted(Ars408General target) const {
  const double sign = options_.invert_azimuth ? -1.0 : 1.0;
  target.y_m *= sign;
  target.vy_mps *= sign;
  return target;
}

Ars408General Ars408Sender::cluster(const Measurement& measurement) {
  return mounted(general(measurement, measurement.doppler_mps,
                         static_across(measurement.range_m, measurement.azimuth_rad)));
}

/// An object's velocity is a vector; each component has its own code and error.
Ars408General Ars408Sender::object(const Measurement& measurement, const Ars408RmsCodes& rms) {
  const RadarView& view = measurement.echo.view;
  const double across_mps =
      setup().is_told_motion ? view.across_mps - told().yaw_rate_radps * view.range_m : 0.0;
  Ars408General target = general(measurement, with_shared_errors(view.doppler_mps), across_mps);
  target.vx_mps += speed_noise_std(rms.vx) * random().normal();
  target.vy_mps += speed_noise_std(rms.vy) * random().normal();
  return mounted(target);
}

/// Ghosts have the same quality as other clusters.
Ars408ClusterQuality Ars408Sender::cluster_quality(const Ars408RmsCodes& rms) {
  Ars408ClusterQuality quality;
  quality.rms = rms;
  if (random().chance(kDoubtShare)) quality.invalid_state = kDoubts[random().index(kDoubts.size())];
  quality.false_alarm_code = random().chance(0.65) ? 1 : 3;
  quality.ambiguity = Ars408Ambiguity::unambiguous;
  return quality;
}

/// Only Doppler shows motion: a target that moves across looks static. Without the vehicle's motion
/// the sensor assumes standstill.
Ars408DynProp Ars408Sender::dyn_prop(const Echo& echo) {
  const double doppler_mps =
      setup().is_told_motion ? echo.view.ground_doppler_mps : echo.view.doppler_mps;
  if (doppler_mps < -kStandingDopplerMps) return Ars408DynProp::oncoming;
  if (doppler_mps > kStandingDopplerMps) return Ars408DynProp::moving;
  const Ars408DynProp standing =
      echo.kind == EchoKind::vehicle ? Ars408DynProp::stopped : Ars408DynProp::stationary;
  return random().chance(0.55) ? standing : Ars408DynProp::stationary_candidate;
}

}  // namespace cremed
