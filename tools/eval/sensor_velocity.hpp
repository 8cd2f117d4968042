// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimator/target_set.hpp"

namespace cremed {

/// Velocity of a radar in its own frame and the offset of its Doppler, (vx, vy, b) in m/s: a target
/// that stands has the Doppler -(vx cos azimuth + vy sin azimuth) + b.
using DopplerState = Eigen::Vector3d;

/// How well the Doppler of one radar is known.
struct DopplerNoise {
  double doppler_std_factor = 1.0;  ///< On what the sensor reports.
  double azimuth_std_factor = 1.0;
  double shared_std_mps = 0.0;  ///< Of an error that all targets of a scan share.
};

/// The line of sight's part in a target's Doppler: what is multiplied with the state.
Eigen::RowVector3d doppler_row(const Target& target);

/// Standard deviation of a target's Doppler through its azimuth, as reported.
double doppler_std_by_azimuth_mps(const Target& target, const DopplerState& state);

/// The velocity that most targets agree on, without offset; nothing if the targets are too few, or
/// in too narrow a sector, to tell. The same targets give the same answer.
std::optional<DopplerState> agreed_velocity(std::span<const Target> targets);

/// Targets whose Doppler is within three standard deviations and `slack_mps` of what is expected.
std::vector<Target> static_targets(std::span<const Target> targets, const DopplerState& expected,
                                   const DopplerNoise& noise, double slack_mps);

/// What a scan says about the state, however few its targets: root * state = measured, with errors
/// of standard deviation 1.
struct DopplerEquations {
  Eigen::Matrix3d root = Eigen::Matrix3d::Zero();
  Eigen::Vector3d measured = Eigen::Vector3d::Zero();
};

/// Of targets that stand; `near` is a state good enough to weight them by.
DopplerEquations doppler_equations(std::span<const Target> targets, const DopplerState& near,
                                   const DopplerNoise& noise);

}  // namespace cremed
