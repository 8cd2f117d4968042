// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace cremed {

/// Index of each quantity in the state of the odometry filter.
namespace state_layout {

// Of the vehicle: pose in the frame of the anchor, and motion. MotionStep propagates these ten.
inline constexpr int kX = 0;                    ///< m
inline constexpr int kY = 1;                    ///< m
inline constexpr int kYaw = 2;                  ///< rad
inline constexpr int kSpeed = 3;                ///< m/s, in the direction of rolling.
inline constexpr int kAcceleration = 4;         ///< m/s^2
inline constexpr int kYawRate = 5;              ///< rad/s
inline constexpr int kYawAcceleration = 6;      ///< rad/s^2
inline constexpr int kSlip = 7;                 ///< rad
inline constexpr int kBodyVelocity = 8;         ///< m/s
inline constexpr int kSlipPerAcceleration = 9;  ///< rad/(m/s^2)
inline constexpr int kMotionStates = 10;

// Common to all radars.
inline constexpr int kRounding = 10;            ///< m/s
inline constexpr int kMixture = 11;             ///< m/s
inline constexpr int kCommonAzimuthScale = 12;  ///< 1
inline constexpr int kCommonScale = 13;         ///< 1
inline constexpr int kCommonYawPerMetre = 14;   ///< rad/m
inline constexpr int kCommonXPerMetre = 15;     ///< 1
inline constexpr int kOutput = 16;              ///< Clone of the pose at the last output.
inline constexpr int kPose = 3;                 ///< States of a clone.
/// Clones of past poses to which the scans of the radars' maps are attached.
inline constexpr int kFirstNode = kOutput + kPose;
inline constexpr int kNodes = 12;
inline constexpr int kFirstRadar = kFirstNode + kNodes * kPose;

// Of one radar, relative to radar(index), in the order of the table of errors (error_table.cpp).
inline constexpr int kDopplerX = 0;         ///< m/s
inline constexpr int kDopplerY = 1;         ///< m/s
inline constexpr int kOffset = 2;           ///< m/s
inline constexpr int kYawPerMetre = 3;      ///< rad/m
inline constexpr int kLateralPerMetre = 4;  ///< 1
inline constexpr int kDopplerScale = 5;     ///< 1
inline constexpr int kMountYaw = 6;         ///< rad
inline constexpr int kAzimuthScale = 7;     ///< 1
inline constexpr int kLeverX = 8;           ///< m
inline constexpr int kLeverY = 9;           ///< m
inline constexpr int kErrorStates = 10;

inline constexpr int node(std::size_t index) {
  return kFirstNode + static_cast<int>(index) * kPose;
}
inline constexpr int radar(int index) { return kFirstRadar + index * kErrorStates; }
inline constexpr int size(int radars) { return radar(radars); }

// Of the signals of the vehicle's bus, relative to size(radars), if there are any.
inline constexpr int kSpeedScale = 0;   ///< 1
inline constexpr int kYawRateGain = 1;  ///< 1
inline constexpr int kYawRateBias = 2;  ///< rad/s
inline constexpr int kVehicleStates = 3;

}  // namespace state_layout

}  // namespace cremed
