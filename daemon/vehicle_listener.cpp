// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/vehicle_listener.hpp"

#include "daemon/configuration/interfaces.hpp"

namespace cremed {

VehicleListener::VehicleListener(const Configuration& configuration)
    : interface_(interfaces_of(configuration).of_vehicle) {
  if (!configuration.vehicle.interface.empty()) {
    ids_ = configuration.vehicle.ids;
  }
}

std::optional<VehicleReading> VehicleListener::read(const CanFrame& frame) {
  if (frame.interface != interface_ || frame.extended || frame.error) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    if (ids_[i] == frame.id) {
      const auto reading = decode_vehicle_reading(static_cast<VehicleSignal>(i), frame);
      bad_frames_[i] += reading ? 0 : 1;
      return reading;
    }
  }
  return std::nullopt;
}

}  // namespace cremed
