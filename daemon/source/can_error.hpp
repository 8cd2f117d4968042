// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/can_decoders/can_frame.hpp"
#include "daemon/source/bus_status.hpp"

namespace cremed {

/// Evaluates an error frame (linux/can/error.h) for the status of its bus: bus state, bus-offs,
/// restarts, and frames lost by the controller, whose number is unknown and counted as one. Returns
/// true if frames were lost.
bool note_error_frame(const CanFrame& error, BusStatus& status);

}  // namespace cremed
