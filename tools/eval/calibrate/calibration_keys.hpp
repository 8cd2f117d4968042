// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/configuration/configuration.hpp"

namespace cremed {

/// A number of the configuration that calibration may find better.
struct CalibratedKey {
  std::string_view table;  ///< Of [[radar]].
  std::string_view key;
  double (*get)(const RadarConfiguration&);
  int decimals;  ///< As printed: below what any drive can tell.
};

/// A key and what to write for it.
struct CalibratedValue {
  const CalibratedKey* key = nullptr;
  std::string text;
};

/// Values of `after` that are others than in `before`.
std::vector<CalibratedValue> changed_values(const RadarConfiguration& before,
                                            const RadarConfiguration& after);

/// Whether a radar has these values, and for all other keys those of `before`.
bool has_values(const RadarConfiguration& radar, const RadarConfiguration& before,
                const std::vector<CalibratedValue>& values);

}  // namespace cremed
