// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>
#include <linux/can/error.h>

#include "daemon/source/can_error.hpp"
#include "test/daemon/error_frame.hpp"

using namespace cremed;
using cremed::test::error_frame;

TEST_CASE("The state of the controller follows its error frames") {
  BusStatus status;
  const auto state_after = [&](std::uint32_t error_class, std::uint8_t controller = 0) {
    note_error_frame(error_frame(error_class, controller), status);
    return status.bus;
  };
  CHECK(state_after(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_WARNING) == BusState::warning);
  CHECK(state_after(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE) == BusState::error_passive);
  CHECK(state_after(CAN_ERR_PROT | CAN_ERR_BUSERROR) == BusState::error_passive);
  CHECK(state_after(CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE) == BusState::error_active);
  CHECK(state_after(CAN_ERR_BUSOFF) == BusState::bus_off);
  CHECK(state_after(CAN_ERR_CRTL, CAN_ERR_CRTL_UNSPEC) == BusState::bus_off);
  CHECK(state_after(CAN_ERR_RESTARTED) == BusState::error_active);
  CHECK(status.error_frames == 7);
  CHECK(status.bus_offs == 1);
  CHECK(status.restarts == 1);
}

TEST_CASE("One frame may tell of several things") {
  BusStatus status;
  note_error_frame(error_frame(CAN_ERR_CRTL | CAN_ERR_BUSOFF, CAN_ERR_CRTL_TX_PASSIVE), status);
  CHECK(status.bus == BusState::bus_off);
  CHECK(status.error_frames == 1);
}

TEST_CASE("Frames that the controller lost are lost frames") {
  BusStatus status;
  CHECK(note_error_frame(error_frame(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW), status));
  CHECK(status.frames_lost == 1);
  CHECK_FALSE(note_error_frame(error_frame(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_OVERFLOW), status));
  CHECK_FALSE(note_error_frame(error_frame(CAN_ERR_ACK, CAN_ERR_CRTL_RX_OVERFLOW), status));
  CHECK(status.frames_lost == 1);
}
