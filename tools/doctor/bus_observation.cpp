// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/bus_observation.hpp"

#include <linux/can/error.h>

#include "daemon/can_error.hpp"

namespace cremed {

void BusObservation::add(const CanFrame& frame) {
  if (frame.error) {
    overruns += note_error_frame(frame, status) ? 1 : 0;
    protocol_errors += (frame.id & (CAN_ERR_PROT | CAN_ERR_BUSERROR)) != 0 ? 1 : 0;
    no_acknowledge += (frame.id & CAN_ERR_ACK) != 0 ? 1 : 0;
    return;
  }
  ++status.frames;
  if (!frame.is_classic_data() || frame.id >= ids.size()) {
    ++foreign_frames;
    return;
  }
  IdObservation& id = ids[frame.id];
  ++id.frames;
  id.length = frame.length;
}

}  // namespace cremed
