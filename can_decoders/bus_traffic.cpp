// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/can_decoders/bus_traffic.hpp"

#include <algorithm>
#include <cstddef>

namespace cremed {

void BusTraffic::add(const CanFrame& frame) {
  if (!frame.is_classic_data() || frame.id >= ids.size()) {
    return;
  }
  IdTraffic& id = ids[frame.id];
  if (id.frames != 0 && frame.stamp_us > id.last_us) {
    id.shortest_gap_us = std::min(id.shortest_gap_us, frame.stamp_us - id.last_us);
  }
  ++id.frames;
  id.last_us = frame.stamp_us;
  id.length = frame.length;
  std::copy_n(frame.data.begin(), id.payload.size(), id.payload.begin());
}

IdSet BusTraffic::seen() const {
  IdSet seen;
  for (std::size_t id = 0; id < ids.size(); ++id) {
    seen[id] = ids[id].frames != 0;
  }
  return seen;
}

}  // namespace cremed
