// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "cremed/can_decoders/can_frame.hpp"

namespace cremed {

/// A frame and the loss before it.
struct ReceivedFrame {
  CanFrame frame;
  std::int64_t received_us = 0;   ///< The kernel's stamp, also if the frame has a hardware stamp.
  std::uint32_t lost_before = 0;  ///< Frames of this interface lost since the last one.
};

}  // namespace cremed
