// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "cremed/can_decoders/vehicle_reading.hpp"
#include "cremed/estimator/fusion/state/odometry.hpp"
#include "daemon/configuration/configuration.hpp"
#include "daemon/report/finding.hpp"

namespace cremed {

/// State of a signal of [vehicle].
struct VehicleStatus {
  VehicleSignalReport odometry;
  std::uint64_t bad_frames = 0;
};

/// "vehicle speed" or "vehicle yaw rate".
std::string vehicle_signal_name(VehicleSignal signal);

/// One line: readings, measurements, learned errors.
std::string vehicle_summary(VehicleSignal signal, const VehicleStatus& status);

/// The fault of a signal that says most.
enum class SignalState : std::uint8_t { ok, lost, frozen, excluded };

SignalState signal_state(const VehicleStatus& status);
std::string_view to_string(SignalState state);

/// Present faults, the worst (signal_state()) first; with `with_past` also those that are over.
std::vector<Finding> vehicle_findings(const VehicleConfiguration& vehicle, VehicleSignal signal,
                                      const VehicleStatus& status, bool with_past);

}  // namespace cremed
