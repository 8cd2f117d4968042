// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/eval/drive/recorded_odometry.hpp"
#include "tools/eval/drive/recorded_states.hpp"
#include "tools/eval/drive/true_trajectory.hpp"
#include "tools/eval/drive/wheel_reference.hpp"

namespace cremed {

/// One axis of a source's motions against the wheels. With e the error against the wheels, t that
/// of truth against them and C the estimate's variance, NEES against truth is the mean of (e - t)^2
/// / C = e^2 / C + t^2 / C - 2 e t / C: the contributions of the estimate, of truth and of both.
/// NaN if truth and wheels cover no estimate.
struct AxisAgainstWheels {
  std::size_t count = 0;
  double nees = 0.0;  ///< e^2 over the sum of C and the wheels' variance.
  double nees_estimate = 0.0;
  double nees_truth = 0.0;
  double nees_cross = 0.0;
  double rms_estimate_per_s = 0.0;  ///< Of e over the motion's time: m/s or rad/s.
  double rms_truth_per_s = 0.0;     ///< Of t.
  double rms_both_per_s = 0.0;      ///< Of e - t.

  [[nodiscard]] double nees_against_truth() const {
    return nees_estimate + nees_truth + nees_cross;
  }
};

struct MotionsAgainstWheels {
  AxisAgainstWheels x;    ///< Distance along the vehicle's axis, against the wheels' speed.
  AxisAgainstWheels yaw;  ///< Against the gyro.
};

MotionsAgainstWheels against_wheels(const std::vector<RecordedEstimate>& estimates,
                                    const TrueTrajectory& truth, const WheelReference& wheels);

/// Truth against the wheels over all intervals of one length that both cover, one each 10 ms. Where
/// the wheels' own error is much smaller (a second or less for wheels accurate to 0.02 m/s), x and
/// yaw are the noise of truth's relative poses, as needed for TruthNoise. NaN if there is no such
/// interval.
struct TruthAgainstWheels {
  double interval_s = 0.0;
  std::size_t count = 0;
  double rms_x_m = 0.0;
  /// Truth's y against a vehicle that rolls in the best fitting constant direction: an upper bound
  /// on the noise of y, because it includes slip in bends.
  double rms_y_m = 0.0;
  double rms_yaw_rad = 0.0;
};

TruthAgainstWheels truth_against_wheels(const TrueTrajectory& truth, const WheelReference& wheels,
                                        std::int64_t interval_us);

/// The state's forward speed and yaw rate against the wheels at the same time; variances are the
/// sum of the state's and the wheels'. NaN if the wheels cover no state.
struct TwistAgainstWheels {
  std::size_t count = 0;
  double nees_speed = 0.0;
  double nees_yaw_rate = 0.0;
  double rms_speed_mps = 0.0;
  double rms_yaw_rate_radps = 0.0;
};

TwistAgainstWheels against_wheels(const std::vector<Odometry>& states,
                                  const WheelReference& wheels);

}  // namespace cremed
