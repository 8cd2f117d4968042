// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace cremed {

/// Index of each quantity in the state of the odometry filter.
namespace state_layout {

// Of the vehicle: pose in the frame of the anchor, and motion. MotionStep propagates these nine.
inline constexpr int kX = 0;                ///< m
inline constexpr int kY = 1;                ///< m
inline constexpr int kYaw = 2;              ///< rad
inline constexpr int kSpeed = 3;            ///< m/s, in the direction of rolling.
inline constexpr int kAcceleration = 4;     ///< m/s^2
inline constexpr int kYawRate = 5;          ///< rad/s
inline constexpr int kYawAcceleration = 6;  ///< rad/s^2
inline constexpr int kSlip = 7;             ///< rad
inline constexpr int kBodyVelocity = 8;     ///< m/s
inline constexpr int kMotionStates = 9;

// Common to all radars.
inline constexpr int kCommonOffset = 9;     ///< m/s
inline constexpr int kCommonYawScale = 10;  ///< 1
inline constexpr int kCommonScale = 11;     ///< 1
inline constexpr int kOutput = 12;          ///< Clone of the pose at the last output.
inline constexpr int kFirstRadar = 15;

// Of one radar, relative to radar(index).
inline constexpr int kMountYaw = 0;         ///< rad
inline constexpr int kDopplerScale = 1;     ///< 1
inline constexpr int kDopplerX = 2;         ///< m/s
inline constexpr int kDopplerY = 3;         ///< m/s
inline constexpr int kOffset = 4;           ///< m/s
inline constexpr int kYawScale = 5;         ///< 1
inline constexpr int kYawPerMetre = 6;      ///< rad/m
inline constexpr int kLateralPerMetre = 7;  ///< 1
inline constexpr int kLeverX = 8;           ///< m
inline constexpr int kLeverY = 9;           ///< m
inline constexpr int kErrorStates = 10;
inline constexpr int kScan = 10;      ///< Clone of the pose at the current scan.
inline constexpr int kKeyframe = 13;  ///< Clones of the poses at the keyframes.
inline constexpr int kKeyframes = 3;
inline constexpr int kPose = 3;  ///< States of a clone.
inline constexpr int kRadarStates = kKeyframe + kKeyframes * kPose;

inline constexpr int radar(int index) { return kFirstRadar + index * kRadarStates; }
inline constexpr int keyframe(int index) { return kKeyframe + index * kPose; }
inline constexpr int size(int radars) { return radar(radars); }

// Of the signals of the vehicle's bus, relative to size(radars), if there are any.
inline constexpr int kSpeedScale = 0;   ///< 1
inline constexpr int kYawRateGain = 1;  ///< 1
inline constexpr int kYawRateBias = 2;  ///< rad/s
inline constexpr int kVehicleStates = 3;

}  // namespace state_layout

}  // namespace cremed
