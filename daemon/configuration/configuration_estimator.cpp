// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <string_view>

#include "cremed/can_decoders/radar_scan.hpp"
#include "daemon/configuration/configuration_sections.hpp"

namespace cremed {
namespace {

constexpr double kWidestViewRad = 6.2832;

/// In the order of Likelihood.
constexpr std::array<std::string_view, 2> kLikelihoods{"exclusive", "max_sum_mixture"};

void read_outlier_ray(TomlReader reader, OutlierRayOptions& ray) {
  reader.number("weight", ray.weight, {0.0, 0.99});
  reader.number("min_range_m", ray.min_range_m, {0.01, 1000.0});
  reader.number("max_range_m", ray.max_range_m, {0.01, 1000.0});
  reader.number("field_of_view_rad", ray.field_of_view_rad, {0.01, kWidestViewRad});
  reader.require_less("min_range_m", ray.min_range_m, "max_range_m", ray.max_range_m);
  reader.finish();
}

void read_doppler(TomlReader reader, DopplerOptions& doppler) {
  reader.boolean("enabled", doppler.enabled);
  reader.number("stamp_std_s", doppler.stamp_std_s, {0.0, 1.0});
  reader.number("moving_weight", doppler.moving_weight, {0.0, 0.99});
  reader.number("moving_std_mps", doppler.moving_std_mps, {0.1, 1000.0});
  reader.finish();
}

void read_shared_errors(TomlReader reader, SharedErrorOptions& errors) {
  reader.number("doppler_offset_std_mps", errors.doppler_offset_std_mps, {0.0, 10.0});
  reader.number("mount_yaw_std_rad", errors.mount_yaw_std_rad, {0.0, 1.0});
  reader.number("velocity_std_mps", errors.velocity_std_mps, {0.0, 10.0});
  reader.number("doppler_scale_std", errors.doppler_scale_std, {0.0, 0.1});
  reader.number("acceleration_std_mps2", errors.acceleration_std_mps2, {0.0, 100.0});
  reader.number("yaw_acceleration_std_radps2", errors.yaw_acceleration_std_radps2, {0.0, 100.0});
  reader.finish();
}

}  // namespace

void read_estimator(TomlReader reader, EgoMotionOptions& options) {
  RegistrationOptions& registration = options.registration;
  reader.integer("degrees_of_freedom", registration.degrees_of_freedom, 2, 3);
  reader.number("start_scale", registration.start_scale, {1.0, 100.0});
  reader.integer("max_iterations", registration.max_iterations, 1, 1000);
  reader.integer("max_component_evaluations", registration.max_component_evaluations, 1'000,
                 100'000'000);
  if (const auto likelihood = reader.choice("likelihood", kLikelihoods)) {
    registration.likelihood = static_cast<Likelihood>(*likelihood);
  }
  reader.integer("min_targets", options.min_targets, 2, kMaxDetections);
  reader.number("max_gap_s", options.max_gap_s, {0.01, 10.0});
  reader.number("standstill_mps", options.standstill_mps, {0.0, 1.0});
  reader.number("max_speed_mps", options.max_speed_mps, {1.0, 150.0});
  reader.number("max_yaw_rate_radps", options.max_yaw_rate_radps, {0.1, 10.0});
  reader.number("max_std_m", options.max_std_m, {0.001, 100.0});
  reader.number("max_std_rad", options.max_std_rad, {0.001, 3.1416});
  read_outlier_ray(reader.table("outlier_ray"), registration.outlier_ray);
  read_doppler(reader.table("doppler"), registration.doppler);
  read_shared_errors(reader.table("shared_errors"), registration.shared_errors);
  reader.finish();
}

}  // namespace cremed
