// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "tools/eval/drive/recorded_states.hpp"
#include "tools/eval/drive/wheel_reference.hpp"

namespace cremed {

/// The state's forward speed and yaw rate against the wheels at the same time; variances are the
/// sum of the state's and the wheels'. NaN if the wheels cover no state.
struct TwistAgainstWheels {
  std::size_t count = 0;
  double nees_speed = 0.0;
  double nees_yaw_rate = 0.0;
  double rms_speed_mps = 0.0;
  double rms_yaw_rate_radps = 0.0;
};

TwistAgainstWheels against_wheels(const std::vector<RecordedState>& states,
                                  const WheelReference& wheels);

}  // namespace cremed
