// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/bus_observation.hpp"

#include <algorithm>
#include <cstddef>

#include <linux/can/error.h>

#include "daemon/process/message_text.hpp"
#include "daemon/source/can_error.hpp"

namespace cremed {

/// Smaller steps backwards are rounding of the stamps.
void BusObservation::note_stamp(std::int64_t stamp_us) {
  constexpr std::int64_t kRoundingUs = 1000;
  const std::int64_t back_us = last_stamp_us.value_or(stamp_us) - stamp_us;
  stamps_back += back_us > kRoundingUs ? 1 : 0;
  longest_back_us = std::max(longest_back_us, back_us);
  longest_leap_us = std::max(longest_leap_us, -back_us);
  last_stamp_us = stamp_us;
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
  if (!frame.is_classic_data() || frame.id >= traffic.ids.size()) {
    ++foreign_frames;
    return;
  }
  traffic.add(frame);
}

std::uint64_t frames_of(const Ars408Options& sensor, Ars408Message message, const BusTraffic& bus) {
  return bus.ids[ars408_id(static_cast<std::uint32_t>(message), sensor.sensor_id)].frames;
}

std::string seen_ids(const BusObservation& bus) {
  constexpr std::size_t kMaxNamed = 8;
  std::string text;
  std::size_t count = 0;
  for (std::size_t id = 0; id < bus.traffic.ids.size(); ++id) {
    if (bus.traffic.ids[id].frames != 0 && ++count <= kMaxNamed) {
      text += concat({count == 1 ? "" : ", ", hexadecimal(id)});
    }
  }
  text += count > kMaxNamed ? concat({" and ", std::to_string(count - kMaxNamed), " more"}) : "";
  if (bus.foreign_frames != 0) {
    text += concat({text.empty() ? "" : ", ", std::to_string(bus.foreign_frames),
                    " extended, remote or FD frames"});
  }
  return text;
}

}  // namespace cremed
