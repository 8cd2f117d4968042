// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "tools/doctor/ars408_talk.hpp"

namespace cremed {

struct Ars408Setup {
  std::optional<double> max_distance_m{};  ///< As it is, if not set.
  bool store = false;                      ///< To flash.
};

/// Sets an ARS408 to what the configuration expects of it: output, quality, no extended messages,
/// sensor id; the range, if asked for. Shows what it reads and would send, asks, sends once, and
/// says of each setting whether the sensor's next 0x201 confirms it.
TalkResult set_up_ars408(const Ars408Talk& talk, const Ars408Setup& setup);

}  // namespace cremed
