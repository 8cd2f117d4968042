// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The terms of CalibrationFit's least squares, for automatic differentiation (LeastSquares).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Core>

#include "tools/eval/calibrate/calibration_fit.hpp"
#include "tools/eval/calibrate/sensor_velocity.hpp"

namespace cremed {

inline constexpr double kNodeS = 0.1;     // Time between nodes.
inline constexpr double kHeldStd = 1e-6;  // Of a state held constant.

/// Motion at the time of a measurement, shifted by `later_s`.
template <typename T>
std::array<T, 3> motion_at(const MotionPlace& at, const T* before, const T* after,
                           const T& later_s) {
  std::array<T, 3> motion;
  for (std::size_t i = 0; i < 3; ++i) {
    motion[i] = before[i] + at.share * (after[i] - before[i]) + at.slope[i] * later_s;
  }
  return motion;
}

/// Velocity of the rear axle to the left.
template <typename T>
T sideways(const T& v, const T& w, const T* vehicle) {
  return v * (vehicle[kRoll] - vehicle[kSlip] * v * w);
}

/// The radar's velocity for the motion (v, w, u) of the vehicle.
template <typename T>
Eigen::Matrix<T, kDopplerStates, 1> doppler_state(const T* motion, const T* vehicle,
                                                  const T* radar) {
  using std::cos;
  using std::sin;
  const T& v = motion[0];
  const T& w = motion[1];
  const T x = (v - w * radar[kY]) * (1.0 + radar[kScale]);
  const T y = (sideways(v, w, vehicle) + motion[2] + w * radar[kX]) * (1.0 + radar[kScale]);
  const T c = cos(radar[kYaw]);
  const T s = sin(radar[kYaw]);
  return Eigen::Matrix<T, kDopplerStates, 1>(c * x + s * y, c * y - s * x, radar[kOffset],
                                             radar[kAzimuth] + radar[kDopplerAzimuth],
                                             radar[kLead]);
}

struct VelocityResidual {
  DopplerEquations equations;
  MotionPlace at;

  template <typename T>
  bool operator()(const T* before, const T* after, const T* vehicle, const T* radar,
                  T* residual) const {
    const auto motion = motion_at(at, before, after, T(radar[kStamp] - at.shift_s));
    const auto state = doppler_state(motion.data(), vehicle, radar);
    Eigen::Map<Eigen::Matrix<T, kDopplerStates, 1>> result(residual);
    result = equations.root.cast<T>() * state - equations.measured.cast<T>();
    return true;
  }
};

struct YawRateResidual {
  YawRateMeasurement measured;
  MotionPlace at;

  template <typename T>
  bool operator()(const T* before, const T* after, const T* radar, T* residual) const {
    const T later_s = radar[kStamp] + radar[kPositionLead] - at.shift_s;
    const T by_azimuth = measured.gain == kMatchedTurn ? T(radar[kAzimuth]) : T(0.0);
    const T turn =
        (1.0 - by_azimuth + radar[measured.gain]) * motion_at(at, before, after, later_s)[1];
    residual[0] = (turn - measured.yaw_rate_radps) / measured.std_radps;
    return true;
  }
};

/// Smoothness of two neighbouring nodes.
struct ChangeResidual {
  double v_std;
  double w_std;

  template <typename T>
  bool operator()(const T* before, const T* after, T* residual) const {
    residual[0] = (after[0] - before[0]) / v_std;
    residual[1] = (after[1] - before[1]) / w_std;
    return true;
  }
};

/// Truth at a node: forward velocity, yaw rate and velocity to the left.
struct TruthResidual {
  MotionNode motion;
  MotionNode std;

  template <typename T>
  bool operator()(const T* node, const T* vehicle, T* residual) const {
    residual[0] = (node[0] - motion[0]) / std[0];
    residual[1] = (node[1] - motion[1]) / std[1];
    residual[2] = (sideways(node[0], node[1], vehicle) - motion[2]) / std[2];
    return true;
  }
};

/// Configured yaw of a mount.
struct YawResidual {
  double yaw_rad;
  double std_rad;

  template <typename T>
  bool operator()(const T* radar, T* residual) const {
    residual[0] = (radar[kYaw] - yaw_rad) / std_rad;
    return true;
  }
};

/// Prior of a node or of the states of a radar or the vehicle.
template <std::size_t N>
struct PriorResidual {
  std::array<double, N> prior;
  std::array<double, N> std;

  template <typename T>
  bool operator()(const T* value, T* residual) const {
    for (std::size_t i = 0; i < N; ++i) {
      residual[i] = (value[i] - prior[i]) / std::max(std[i], kHeldStd);
    }
    return true;
  }
};

}  // namespace cremed
