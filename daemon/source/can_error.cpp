// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/source/can_error.hpp"

#include <linux/can/error.h>

namespace cremed {
namespace {

constexpr std::size_t kControllerByte = 1;

BusState state_of(std::uint8_t controller, BusState before) {
  if ((controller & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) {
    return BusState::error_passive;
  }
  if ((controller & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0) {
    return BusState::warning;
  }
  return (controller & CAN_ERR_CRTL_ACTIVE) != 0 ? BusState::error_active : before;
}

}  // namespace

bool note_error_frame(const CanFrame& error, BusStatus& status) {
  ++status.error_frames;
  if ((error.id & CAN_ERR_RESTARTED) != 0) {
    ++status.restarts;
    status.bus = BusState::error_active;
  }
  bool lost = false;
  if ((error.id & CAN_ERR_CRTL) != 0) {
    const std::uint8_t controller = error.data[kControllerByte];
    status.bus = state_of(controller, status.bus);
    lost = (controller & CAN_ERR_CRTL_RX_OVERFLOW) != 0;
    status.frames_lost += lost ? 1 : 0;
  }
  if ((error.id & CAN_ERR_BUSOFF) != 0) {
    ++status.bus_offs;
    status.bus = BusState::bus_off;
  }
  return lost;
}

}  // namespace cremed
