// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/configuration/configuration.hpp"

namespace cremed {

/// A key of the configuration that calibration can change.
struct CalibratedKey {
  std::string_view table;  ///< Below [[radar]], or of the vehicle's key.
  std::string_view key;
  double (*get)(const RadarConfiguration&);  ///< Null: of the vehicle.
  int decimals;                              ///< As printed: finer than any drive can determine.
};

/// A key and its text.
struct CalibratedValue {
  const CalibratedKey* key = nullptr;
  std::string text;
};

/// The values of `after` that differ from `before`.
std::vector<CalibratedValue> changed_values(const RadarConfiguration& before,
                                            const RadarConfiguration& after);

/// The slip per lateral acceleration of `after`, in [odometry], if it differs from that of
/// `before`.
std::vector<CalibratedValue> changed_vehicle_values(const OdometryOptions& before,
                                                    const OdometryOptions& after);

/// Whether a radar has these values, and for all other keys those of `before`.
bool has_values(const RadarConfiguration& radar, const RadarConfiguration& before,
                const std::vector<CalibratedValue>& values);

}  // namespace cremed
