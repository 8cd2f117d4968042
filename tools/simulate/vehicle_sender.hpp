// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "cremed/can_decoders/vehicle_reading.hpp"
#include "daemon/configuration/configuration.hpp"
#include "tools/simulate/can_bus.hpp"
#include "tools/simulate/told_motion.hpp"

namespace cremed {

/// Constant errors of the vehicle's sensors.
struct VehicleErrors {
  double speed_scale = 1.0;
  double yaw_rate_scale = 1.0;
  double yaw_rate_bias_radps = 0.0;
};

/// The vehicle's node that sends speed and yaw rate (0x300, 0x301), each every 20 ms as Apollo
/// does.
class VehicleSender final : public BusSender {
 public:
  /// Sends up to `end_us`. `bus` must outlive the sender.
  VehicleSender(const VehicleBus& bus, const VehicleErrors& errors, const VehicleConfiguration& ids,
                std::int64_t start_us, std::int64_t end_us);

  [[nodiscard]] FrameRequest request() const override;
  CanFrame send(std::int64_t stamp_us) override;

 private:
  [[nodiscard]] CanFrame frame(VehicleSignal signal) const;

  const VehicleBus& bus_;
  VehicleErrors errors_;
  std::array<std::optional<std::uint32_t>, kVehicleSignals> ids_;
  std::int64_t start_us_;
  std::int64_t end_us_;
  std::int64_t next_us_;
  std::size_t turn_ = 0;
};

}  // namespace cremed
