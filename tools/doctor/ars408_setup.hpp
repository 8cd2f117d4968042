// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "tools/doctor/ars408_talk.hpp"

namespace cremed {

struct Ars408Setup {
  std::optional<double> max_distance_m{};  ///< Unchanged if not set.
  bool store = false;                      ///< To flash.
};

/// Sets an ARS408 to what the configuration expects: output, quality, no extended messages, sensor
/// id, and optionally the range. Shows present and wanted settings, asks for consent, sends once,
/// and reports which settings the next 0x201 confirms.
TalkResult set_up_ars408(const Ars408Talk& talk, const Ars408Setup& setup);

}  // namespace cremed
