// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The terms of CalibrationFit's least squares, as Ceres differentiates them.

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Core>

#include "tools/eval/calibration_fit.hpp"
#include "tools/eval/sensor_velocity.hpp"

namespace cremed {

inline constexpr double kNodeS = 0.1;     // From node to node.
inline constexpr double kHeldStd = 1e-6;  // Of a state that is held.

template <typename T>
T between(const T* before, const T* after, const T& share, int i) {
  return before[i] + share * (after[i] - before[i]);
}

/// The radar's for the vehicle's (v, w).
template <typename T>
Eigen::Matrix<T, 4, 1> doppler_state(const T& v, const T& w, const T* radar) {
  using std::cos;
  using std::sin;
  const T x = (v - w * radar[kY]) * (1.0 + radar[kScale]);
  const T y = w * radar[kX] * (1.0 + radar[kScale]);
  const T c = cos(radar[kYaw]);
  const T s = sin(radar[kYaw]);
  return {c * x + s * y, c * y - s * x, radar[kOffset], radar[kAzimuth]};
}

struct VelocityResidual {
  DopplerEquations equations;
  double share;  // Of the way from node to node, without stamp offset.

  template <typename T>
  bool operator()(const T* before, const T* after, const T* radar, T* residual) const {
    const T at = share + radar[kStamp] / kNodeS;
    const auto state =
        doppler_state(between(before, after, at, 0), between(before, after, at, 1), radar);
    Eigen::Map<Eigen::Matrix<T, 4, 1>> result(residual);
    result = equations.root.cast<T>() * state - equations.measured.cast<T>();
    return true;
  }
};

struct YawRateResidual {
  YawRateMeasurement measured;
  double share;

  template <typename T>
  bool operator()(const T* before, const T* after, const T* radar, T* residual) const {
    const T at = share + radar[kStamp] / kNodeS;
    const T turn = (1.0 + radar[kTurn]) * between(before, after, at, 1);
    residual[0] = (turn - measured.yaw_rate_radps) / measured.std_radps;
    return true;
  }
};

/// Two nodes that follow on each other: the vehicle cannot change at will.
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

/// What is known of a node by itself.
struct NodeResidual {
  double v_mps;
  double w_radps;
  double v_std;
  double w_std;

  template <typename T>
  bool operator()(const T* node, T* residual) const {
    residual[0] = (node[0] - v_mps) / v_std;
    residual[1] = (node[1] - w_radps) / w_std;
    return true;
  }
};

struct PriorResidual {
  CalibrationVector prior;
  CalibrationVector std;

  template <typename T>
  bool operator()(const T* radar, T* residual) const {
    for (std::size_t i = 0; i < kCalibrationStates; ++i) {
      residual[i] = (radar[i] - prior[i]) / std::max(std[i], kHeldStd);
    }
    return true;
  }
};

}  // namespace cremed
