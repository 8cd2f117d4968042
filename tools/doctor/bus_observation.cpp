// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/bus_observation.hpp"

#include <algorithm>
#include <span>

#include <linux/can/error.h>

#include "cremed/can_decoders/ars408_messages.hpp"
#include "daemon/source/can_error.hpp"

namespace cremed {

/// Stamps of one bus are those of one clock; what differs by less is how they were rounded.
void BusObservation::note_stamp(std::int64_t stamp_us) {
  constexpr std::int64_t kRoundingUs = 1000;
  const std::int64_t back_us = last_stamp_us.value_or(stamp_us) - stamp_us;
  stamps_back += back_us > kRoundingUs ? 1 : 0;
  longest_back_us = std::max(longest_back_us, back_us);
  last_stamp_us = stamp_us;
}

void BusObservation::note_state(const CanFrame& frame) {
  if (ars408_base_id(frame.id) == static_cast<std::uint32_t>(Ars408Message::radar_state)) {
    const std::uint8_t sensor = ars408_sensor_id(frame.id);
    const auto report = decode_ars408_radar_state(std::span(frame.data).first(frame.length));
    const bool is_own = state_watches_[sensor].is_own(sensor, report, frame.stamp_us);
    ars408_states[sensor] += is_own ? 1 : 0;
  }
}

void BusObservation::add(const CanFrame& frame) {
  note_stamp(frame.stamp_us);
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
  note_state(frame);
}

}  // namespace cremed
