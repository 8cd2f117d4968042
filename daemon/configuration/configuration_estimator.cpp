// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <string_view>

#include "cremed/can_decoders/radar_scan.hpp"
#include "daemon/configuration/configuration_sections.hpp"

namespace cremed {
namespace {

/// In the order of Likelihood.
constexpr std::array<std::string_view, 2> kLikelihoods{"exclusive", "max_sum_mixture"};

void read_outlier_ray(TomlReader reader, OutlierRayOptions& ray) {
  reader.number("weight", ray.weight, {0.0, 0.99});
  reader.finish();
}

void read_doppler(TomlReader reader, DopplerOptions& doppler) {
  reader.boolean("enabled", doppler.enabled);
  reader.number("moving_weight", doppler.moving_weight, {0.0, 0.99});
  reader.finish();
}

void read_shared_errors(TomlReader reader, SharedErrorOptions& errors) {
  reader.number("doppler_offset_std_mps", errors.doppler_offset_std_mps, {0.0, 10.0});
  reader.number("mount_yaw_std_rad", errors.mount_yaw_std_rad, {0.0, 1.0});
  reader.number("velocity_std_mps", errors.velocity_std_mps, {0.0, 10.0});
  reader.number("doppler_scale_std", errors.doppler_scale_std, {0.0, 0.1});
  reader.finish();
}

}  // namespace

void read_estimator(TomlReader reader, EgoMotionOptions& options) {
  RegistrationOptions& registration = options.registration;
  reader.integer("degrees_of_freedom", registration.degrees_of_freedom, 2, 3);
  reader.number("start_scale", registration.start_scale, {1.0, 100.0});
  if (const auto likelihood = reader.choice("likelihood", kLikelihoods)) {
    registration.likelihood = static_cast<Likelihood>(*likelihood);
  }
  reader.integer("min_targets", options.min_targets, 2, kMaxDetections);
  reader.number("max_gap_s", options.max_gap_s, {0.01, 10.0});
  read_outlier_ray(reader.table("outlier_ray"), registration.outlier_ray);
  read_doppler(reader.table("doppler"), registration.doppler);
  read_shared_errors(reader.table("shared_errors"), registration.shared_errors);
  reader.finish();
}

}  // namespace cremed
