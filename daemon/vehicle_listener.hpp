// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "cremed/can_decoders/can_frame.hpp"
#include "cremed/can_decoders/vehicle_reading.hpp"
#include "daemon/configuration/configuration.hpp"

namespace cremed {

/// Reads speed and yaw rate of the vehicle from the frames of other nodes ([vehicle] in the
/// configuration). The kernel does not return our own frames to the socket that sent them
/// (CAN_RAW_RECV_OWN_MSGS is off), and the configuration refuses motion_feedback beside [vehicle].
class VehicleListener {
 public:
  explicit VehicleListener(const Configuration& configuration);

  /// The reading in a frame, if it holds one.
  std::optional<VehicleReading> read(const CanFrame& frame);

  /// Frames with the right identifier that cannot be read, by signal.
  [[nodiscard]] std::uint64_t bad_frames(VehicleSignal signal) const {
    return bad_frames_[static_cast<std::size_t>(signal)];
  }

 private:
  std::uint8_t interface_;
  std::array<std::optional<std::uint32_t>, kVehicleSignals> ids_;
  std::array<std::uint64_t, kVehicleSignals> bad_frames_{};
};

}  // namespace cremed
