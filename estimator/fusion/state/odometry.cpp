// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/state/odometry.hpp"

#include <array>

namespace cremed {

std::string_view to_string(OdometryStatus status) {
  static constexpr std::array<std::string_view, kOdometryStatusCount> kNames{
      "ok", "standing_still", "initialising", "predicted", "ambiguous", "lost"};
  return kNames[static_cast<std::size_t>(status)];
}

}  // namespace cremed
