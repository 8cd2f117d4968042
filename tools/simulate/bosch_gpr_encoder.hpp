// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "cremed/can_decoders/bosch_gpr.hpp"
#include "cremed/can_decoders/can_frame.hpp"

namespace cremed {

/// Steps of the values in the frames.
inline constexpr double kGprRangeStepM = 0.0625;
inline constexpr double kGprDopplerStepMps = 0.0625;
inline constexpr double kGprAzimuthStepRad = 0.0002;
inline constexpr double kGprAzimuthStdStepRad = 0.001;

/// The sensor's messages as frames without stamp and interface, with checksum. Values are clamped
/// to the range of the frame. `id` of a target is its slot; of an A message that is not `measured`
/// only slot and counter are sent.
CanFrame encode_bosch_gpr(std::uint32_t base_id, const BoschGprTargetA& target);
CanFrame encode_bosch_gpr(std::uint32_t base_id, const BoschGprTargetB& target);
CanFrame encode_bosch_gpr_info(std::uint32_t info_id, const BoschGprInfo& info);

/// Sets the age of the measurement in a B message, which is known only on sending.
void set_bosch_gpr_age(CanFrame& target_b, std::int64_t age_us);

}  // namespace cremed
