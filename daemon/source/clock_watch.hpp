// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/process/descriptor.hpp"

namespace cremed {

/// Detects steps of the system clock (NTP, by hand, resume). Stamps are of that clock, so no
/// duration may span a step. Slewing is not a step.
class ClockWatch {
 public:
  ClockWatch();

  /// Readable after a step; -1 if the kernel does not support it.
  [[nodiscard]] int descriptor() const { return descriptor_.number(); }

  /// Whether the clock was set since the last call. Does not block.
  bool was_set();

 private:
  void arm();

  Descriptor descriptor_;
};

}  // namespace cremed
