// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <istream>
#include <vector>

#include "cremed/can_decoders/detection.hpp"
#include "cremed/estimator/scan/pose2.hpp"

namespace cremed {

/// Two scans with the true motion between them.
struct RegistrationPair {
  Pose2 truth;
  double dt_s = 0.0;
  Pose2 vehicle_from_radar;
  std::vector<Detection> previous;
  std::vector<Detection> current;
};

/// Reads pairs as text, one item per line:
///     T,pair,x,y,yaw,dt                  true motion (m, rad) and time (s); begins a pair
///     M,pair,x,y,yaw                     mount, optional
///     D,pair,scan,id,range,azimuth,doppler,range_std,azimuth_std,doppler_std
/// with scan 0 the previous and 1 the current; lines that begin with # are comments. Throws
/// std::runtime_error "line N: ..." for anything else.
std::vector<RegistrationPair> read_registration_pairs(std::istream& input);

}  // namespace cremed
