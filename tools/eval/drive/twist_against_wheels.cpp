// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/twist_against_wheels.hpp"

#include <cmath>
#include <limits>

namespace cremed {

TwistAgainstWheels against_wheels(const std::vector<RecordedState>& states,
                                  const WheelReference& wheels) {
  const double speed_variance = std::pow(wheels.std().speed_mps, 2);
  const double yaw_rate_variance = std::pow(wheels.std().yaw_rate_radps, 2);
  TwistAgainstWheels result;
  for (const RecordedState& state : states) {
    if (const auto rates = wheels.rates(state.utime_us)) {
      const double speed_2 = std::pow(state.twist.x() - rates->x(), 2);
      const double yaw_rate_2 = std::pow(state.twist.z() - rates->y(), 2);
      ++result.count;
      result.nees_speed += speed_2 / (state.twist_covariance(0, 0) + speed_variance);
      result.nees_yaw_rate += yaw_rate_2 / (state.twist_covariance(2, 2) + yaw_rate_variance);
      result.rms_speed_mps += speed_2;
      result.rms_yaw_rate_radps += yaw_rate_2;
    }
  }
  const double count = result.count == 0 ? std::numeric_limits<double>::quiet_NaN()
                                         : static_cast<double>(result.count);
  result.nees_speed /= count;
  result.nees_yaw_rate /= count;
  result.rms_speed_mps = std::sqrt(result.rms_speed_mps / count);
  result.rms_yaw_rate_radps = std::sqrt(result.rms_yaw_rate_radps / count);
  return result;
}

}  // namespace cremed
