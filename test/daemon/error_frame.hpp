// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "cremed/can_decoders/can_frame.hpp"

namespace cremed::test {

/// In the format of linux/can/error.h: the class, and the controller's state.
inline CanFrame error_frame(std::uint32_t error_class, std::uint8_t controller = 0) {
  CanFrame frame;
  frame.error = true;
  frame.id = error_class;
  frame.length = 8;
  frame.data[1] = controller;
  return frame;
}

}  // namespace cremed::test
