// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/calibrate/calibration_keys.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#include <spdlog/fmt/fmt.h>

namespace cremed {
namespace {

using Radar = RadarConfiguration;

const Pose2& mount(const Radar& radar) { return radar.ego_motion.vehicle_from_radar; }
const DetectionCorrection& correction(const Radar& radar) { return radar.ego_motion.correction; }

constexpr std::array<CalibratedKey, 11> kKeys = {{
    {"mount", "x_m", [](const Radar& r) { return mount(r).x_m; }, 3},
    {"mount", "y_m", [](const Radar& r) { return mount(r).y_m; }, 3},
    {"mount", "yaw_rad", [](const Radar& r) { return mount(r).yaw_rad; }, 5},
    {"calibration", "stamp_offset_s", [](const Radar& r) { return r.stamp_offset_s; }, 4},
    {"calibration", "rotation_lead_s", [](const Radar& r) { return correction(r).rotation_lead_s; },
     4},
    {"calibration", "azimuth_scale", [](const Radar& r) { return correction(r).azimuth_scale; }, 4},
    {"calibration", "doppler_offset_mps",
     [](const Radar& r) { return correction(r).doppler_offset_mps; }, 3},
    {"calibration", "doppler_scale", [](const Radar& r) { return correction(r).doppler_scale; }, 4},
    {"calibration", "range_std_factor",
     [](const Radar& r) { return correction(r).range_std_factor; }, 2},
    {"calibration", "azimuth_std_factor",
     [](const Radar& r) { return correction(r).azimuth_std_factor; }, 2},
    {"calibration", "doppler_std_factor",
     [](const Radar& r) { return correction(r).doppler_std_factor; }, 2},
}};

constexpr CalibratedKey kSlipKey = {"odometry", "slip_per_lateral_acceleration", nullptr, 5};

std::string digits(double value, int decimals) { return fmt::format("{:.{}f}", value, decimals); }

}  // namespace

std::vector<CalibratedValue> changed_values(const Radar& before, const Radar& after) {
  std::vector<CalibratedValue> values;
  for (const CalibratedKey& key : kKeys) {
    if (key.get(before) != key.get(after)) {
      values.push_back({&key, digits(key.get(after), key.decimals)});
    }
  }
  return values;
}

std::vector<CalibratedValue> changed_vehicle_values(const OdometryOptions& before,
                                                    const OdometryOptions& after) {
  const double slip = after.slip_per_lateral_acceleration;
  if (slip == before.slip_per_lateral_acceleration) {
    return {};
  }
  return {{&kSlipKey, digits(slip, kSlipKey.decimals)}};
}

bool has_values(const Radar& radar, const Radar& before,
                const std::vector<CalibratedValue>& values) {
  return std::ranges::all_of(kKeys, [&](const CalibratedKey& key) {
    const auto changed = std::ranges::find(values, &key, &CalibratedValue::key);
    const double wanted =
        changed == values.end() ? key.get(before) : std::strtod(changed->text.c_str(), nullptr);
    return key.get(radar) == wanted;
  });
}

}  // namespace cremed
