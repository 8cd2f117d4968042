// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "tools/eval/recorded_drive.hpp"

namespace cremed {

/// Velocity of a radar in its own frame, offset of its Doppler, true over reported azimuth - 1 and
/// its rotation lead (vx, vy, b, k, tau; m/s, 1 and s): with the yaw rate w that the sensor
/// receives, a static target at range r has the Doppler
///
///     -(vx cos((1 + k) azimuth) + vy sin((1 + k) azimuth)) + b + tau w^2 r
///
/// Without k, an azimuth error of one per cent would appear as a Doppler offset. tau is relative to
/// the configured lead, and k to the configured scale (estimator/scan/rotation_lead.hpp).
inline constexpr int kDopplerStates = 5;
using DopplerState = Eigen::Matrix<double, kDopplerStates, 1>;
using DopplerRow = Eigen::Matrix<double, 1, kDopplerStates>;
using DopplerMatrix = Eigen::Matrix<double, kDopplerStates, kDopplerStates>;

/// Uncertainty of one radar's Doppler.
struct DopplerNoise {
  double doppler_std_factor = 1.0;  ///< On the reported one.
  double azimuth_std_factor = 1.0;
  /// Of errors that all targets of a scan share: the offset and both velocities.
  double shared_offset_std_mps = 0.0;
  double shared_velocity_std_mps = 0.0;
};

/// Derivative of a target's Doppler by the state; for small k, the Doppler is this times the state.
DopplerRow doppler_row(const Target& target, const DopplerState& near, double told_yaw_rate_radps);

/// Standard deviation of a target's Doppler due to its reported azimuth noise.
double doppler_std_by_azimuth_mps(const Target& target, const DopplerState& state);

/// The velocity on which most targets agree, without offset; nothing if the targets are too few or
/// in too narrow a sector. Deterministic.
std::optional<DopplerState> agreed_velocity(std::span<const Target> targets);

inline constexpr double kGateSigma = 3.0;

/// The scan with the targets whose Doppler is within kGateSigma standard deviations and 0.1 m/s of
/// the expected one.
RecordedScan static_part(const RecordedScan& scan, const DopplerState& expected,
                         const DopplerNoise& noise = {});

/// Information of a scan about the state, for any number of targets: root * state = measured, with
/// errors of standard deviation 1.
struct DopplerEquations {
  DopplerMatrix root = DopplerMatrix::Zero();
  DopplerState measured = DopplerState::Zero();
};

/// Of a scan of static targets; `near` is an approximate state, for the weights.
DopplerEquations doppler_equations(const RecordedScan& scan, const DopplerState& near,
                                   const DopplerNoise& noise);

}  // namespace cremed
