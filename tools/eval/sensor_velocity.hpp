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

/// Velocity of a radar in its own frame, the offset of its Doppler and the relative error of its
/// azimuths, (vx, vy, b, e) in m/s and 1: a target that stands has the Doppler
///
///     -(vx cos((1 - e) azimuth) + vy sin((1 - e) azimuth)) + b
///
/// Without e, azimuths that are wrong by a per cent would look like an offset of Doppler.
using DopplerState = Eigen::Vector4d;

/// How well the Doppler of one radar is known.
struct DopplerNoise {
  double doppler_std_factor = 1.0;  ///< On what the sensor reports.
  double azimuth_std_factor = 1.0;
  double shared_std_mps = 0.0;  ///< Of an error that all targets of a scan share.
};

/// A target's Doppler over the state; with small e, the Doppler is this times the state.
Eigen::RowVector4d doppler_row(const Target& target, const DopplerState& near);

/// Standard deviation of a target's Doppler through its azimuth, as reported.
double doppler_std_by_azimuth_mps(const Target& target, const DopplerState& state);

/// The velocity that most targets agree on, without offset; nothing if the targets are too few, or
/// in too narrow a sector, to tell. The same targets give the same answer.
std::optional<DopplerState> agreed_velocity(std::span<const Target> targets);

inline constexpr double kGateSigma = 3.0;

/// Targets whose Doppler is within kGateSigma standard deviations and `slack_mps` of what is
/// expected.
std::vector<Target> static_targets(std::span<const Target> targets, const DopplerState& expected,
                                   const DopplerNoise& noise, double slack_mps);

/// What a scan says about the state, however few its targets: root * state = measured, with errors
/// of standard deviation 1.
struct DopplerEquations {
  Eigen::Matrix4d root = Eigen::Matrix4d::Zero();
  Eigen::Vector4d measured = Eigen::Vector4d::Zero();
};

/// Of targets that stand; `near` is a state good enough to weight them by.
DopplerEquations doppler_equations(std::span<const Target> targets, const DopplerState& near,
                                   const DopplerNoise& noise);

}  // namespace cremed
