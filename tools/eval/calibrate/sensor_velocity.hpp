// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "tools/eval/recorded_drive.hpp"

namespace cremed {

/// Velocity of a radar in its own frame, offset of its Doppler, relative error of its azimuths and
/// its rotation lead (vx, vy, b, e, tau; m/s, 1 and s): at the range r and the yaw rate w that the
/// sensor is told, a target that stands has the Doppler
///
///     -(vx cos((1 - e) azimuth) + vy sin((1 - e) azimuth)) + b + tau w^2 r
///
/// Without e, azimuths that are wrong by a per cent would look like an offset of Doppler. tau is
/// what the configured lead leaves (estimator/scan/rotation_lead.hpp).
inline constexpr int kDopplerStates = 5;
using DopplerState = Eigen::Matrix<double, kDopplerStates, 1>;
using DopplerRow = Eigen::Matrix<double, 1, kDopplerStates>;
using DopplerMatrix = Eigen::Matrix<double, kDopplerStates, kDopplerStates>;

/// How well the Doppler of one radar is known.
struct DopplerNoise {
  double doppler_std_factor = 1.0;  ///< On what the sensor reports.
  double azimuth_std_factor = 1.0;
  /// Of errors that all targets of a scan share: of the offset and of both velocities.
  double shared_offset_std_mps = 0.0;
  double shared_velocity_std_mps = 0.0;
};

/// A target's Doppler over the state; with small e, the Doppler is this times the state.
DopplerRow doppler_row(const Target& target, const DopplerState& near, double told_yaw_rate_radps);

/// Standard deviation of a target's Doppler through its azimuth, as reported.
double doppler_std_by_azimuth_mps(const Target& target, const DopplerState& state);

/// The velocity that most targets agree on, without offset; nothing if the targets are too few, or
/// in too narrow a sector, to tell. The same targets give the same answer.
std::optional<DopplerState> agreed_velocity(std::span<const Target> targets);

inline constexpr double kGateSigma = 3.0;

/// The scan with those targets whose Doppler is within kGateSigma standard deviations and
/// `slack_mps` of what is expected.
RecordedScan static_part(const RecordedScan& scan, const DopplerState& expected,
                         const DopplerNoise& noise, double slack_mps);

/// What a scan says about the state, however few its targets: root * state = measured, with errors
/// of standard deviation 1.
struct DopplerEquations {
  DopplerMatrix root = DopplerMatrix::Zero();
  DopplerState measured = DopplerState::Zero();
};

/// Of a scan whose targets stand; `near` is a state good enough to weight them by.
DopplerEquations doppler_equations(const RecordedScan& scan, const DopplerState& near,
                                   const DopplerNoise& noise);

}  // namespace cremed
