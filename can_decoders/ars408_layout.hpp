// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <numbers>

#include "cremed/can_decoders/bit_field.hpp"

/// Position (Motorola order) and scale of each signal of an ARS408.
namespace cremed::ars408_layout {

inline constexpr double kDegPerRad = 180.0 / std::numbers::pi;

// The first byte of each message of a target is its id.
inline constexpr BitField kId{0, 8};

namespace status {
inline constexpr BitField kNearCount{0, 8};
inline constexpr BitField kFarCount{8, 8};
inline constexpr BitField kClusterCounter{24, 16};
inline constexpr BitField kClusterInterface{36, 4};
inline constexpr BitField kObjectCount{0, 8};
inline constexpr BitField kObjectCounter{16, 16};
inline constexpr BitField kObjectInterface{28, 4};
}  // namespace status

namespace general {
inline constexpr BitField kX{19, 13};
inline constexpr BitField kClusterY{24, 10};
inline constexpr BitField kObjectY{24, 11};
inline constexpr BitField kVx{46, 10};
inline constexpr BitField kVy{53, 9};
inline constexpr BitField kDynProp{48, 3};
inline constexpr BitField kRcs{56, 8};
inline constexpr LinearScale kXScale{2500.0, 5.0};
inline constexpr LinearScale kClusterYScale{511.5, 5.0};
inline constexpr LinearScale kObjectYScale{1023.0, 5.0};
inline constexpr LinearScale kVxScale{512.0, 4.0};
inline constexpr LinearScale kVyScale{256.0, 4.0};
inline constexpr LinearScale kRcsScale{128.0, 2.0};
}  // namespace general

namespace quality {
inline constexpr BitField kXRms{11, 5};
inline constexpr BitField kYRms{22, 5};
inline constexpr BitField kVxRms{17, 5};
inline constexpr BitField kVyRms{28, 5};
inline constexpr BitField kFalseAlarm{24, 3};
inline constexpr BitField kInvalidState{35, 5};
inline constexpr BitField kAmbiguity{32, 3};
inline constexpr BitField kAxRms{39, 5};
inline constexpr BitField kAyRms{34, 5};
inline constexpr BitField kOrientationRms{45, 5};
inline constexpr BitField kMeasurementState{50, 3};
inline constexpr BitField kExistence{53, 3};
}  // namespace quality

namespace state {
inline constexpr std::uint8_t kNvmWritten = 7;
inline constexpr std::uint8_t kNvmRead = 6;
inline constexpr BitField kMaxDistance{22, 10};
inline constexpr std::uint8_t kPersistentError = 21;
inline constexpr std::uint8_t kInterference = 20;
inline constexpr std::uint8_t kTemperatureError = 19;
inline constexpr std::uint8_t kTemporaryError = 18;
inline constexpr std::uint8_t kVoltageError = 17;
inline constexpr BitField kPower{39, 3};
inline constexpr BitField kSort{36, 3};
inline constexpr BitField kSensorId{32, 3};
// MotionRxState: 1 speed missing, 2 yaw rate missing, 3 both.
inline constexpr std::uint8_t kSpeedMissing = 46;
inline constexpr std::uint8_t kYawRateMissing = 47;
inline constexpr std::uint8_t kSendsExtended = 45;
inline constexpr std::uint8_t kSendsQuality = 44;
inline constexpr BitField kOutput{42, 2};
inline constexpr std::uint8_t kRelayControl = 41;
inline constexpr BitField kRcsThreshold{58, 3};
inline constexpr LinearScale kMaxDistanceScale{0.0, 0.5};
}  // namespace state

/// 0x200. The sensor ignores a signal whose valid bit is not set.
namespace configuration {
inline constexpr std::uint8_t kMaxDistanceValid = 0;
inline constexpr std::uint8_t kSensorIdValid = 1;
inline constexpr std::uint8_t kPowerValid = 2;
inline constexpr std::uint8_t kOutputValid = 3;
inline constexpr std::uint8_t kSendsQualityValid = 4;
inline constexpr std::uint8_t kSendsExtendedValid = 5;
inline constexpr std::uint8_t kSortValid = 6;
inline constexpr std::uint8_t kStoreValid = 7;
inline constexpr std::uint8_t kRelayControlValid = 40;
inline constexpr std::uint8_t kRcsThresholdValid = 48;
inline constexpr BitField kMaxDistance{22, 10};
inline constexpr BitField kSensorId{32, 3};
inline constexpr BitField kPower{37, 3};
inline constexpr BitField kOutput{35, 2};
inline constexpr BitField kSendsQuality{42, 1};
inline constexpr BitField kSendsExtended{43, 1};
inline constexpr BitField kSort{44, 3};
inline constexpr BitField kStore{47, 1};
inline constexpr BitField kRelayControl{41, 1};
inline constexpr BitField kRcsThreshold{49, 3};
inline constexpr LinearScale kMaxDistanceScale{0.0, 0.5};
}  // namespace configuration

/// 0x300 and 0x301.
namespace motion {
inline constexpr BitField kDirection{6, 2};
inline constexpr std::uint8_t kStandstill = 0;
inline constexpr std::uint8_t kForward = 1;
inline constexpr std::uint8_t kBackward = 2;
inline constexpr BitField kSpeed{8, 13};
inline constexpr BitField kYawRate{8, 16};
inline constexpr LinearScale kSpeedScale{0.0, 50.0};
inline constexpr LinearScale kYawRateScale{32768.0, 100.0 * kDegPerRad};
}  // namespace motion

namespace version {
inline constexpr BitField kMajor{0, 8};
inline constexpr BitField kMinor{8, 8};
inline constexpr BitField kPatch{16, 8};
inline constexpr std::uint8_t kExtendedRange = 25;
inline constexpr std::uint8_t kPowerRestricted = 24;
}  // namespace version

namespace filter {
inline constexpr std::uint8_t kForObjects = 7;
inline constexpr BitField kIndex{3, 4};
inline constexpr std::uint8_t kActive = 2;
inline constexpr std::uint8_t kValid = 1;  // 0x202 only.

/// The limits of a filter have the width and scale of its criterion, the index here.
struct Limits {
  std::uint8_t length;
  LinearScale scale;
};
inline constexpr LinearScale kCode{0.0, 1.0};
inline constexpr LinearScale kTenths{0.0, 10.0};
inline constexpr LinearScale kSpeed{0.0, 2000.0 / 63.0};
inline constexpr std::array<Limits, 16> kLimits{{
    {12, kCode},
    {12, kTenths},
    {12, {2000.0, 40.0 * kDegPerRad}},
    {12, kSpeed},
    {12, kSpeed},
    {12, {2000.0, 40.0}},
    {12, kTenths},
    {12, {0.0, 40.0}},
    {12, kCode},
    {12, {2047.5, 5.0}},
    {13, {2500.0, 5.0}},
    {12, kSpeed},
    {12, kSpeed},
    {12, kSpeed},
    {12, kSpeed},
    {8, kCode},
}};
inline constexpr std::uint8_t kMin = 16;
inline constexpr std::uint8_t kMax = 32;
}  // namespace filter

}  // namespace cremed::ars408_layout
