// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace cremed {

/// Real-time state of the process. The service manager sets the priority
/// (CPUSchedulingPolicy=fifo).
struct RealTimeState {
  bool has_priority = false;  ///< SCHED_FIFO or SCHED_RR.
  int priority = 0;
  bool memory_locked = false;

  /// What is missing and how to obtain it; empty if nothing is.
  [[nodiscard]] std::string problem() const;
};

/// Locks present and future memory and touches the stack of the hot path: a page fault costs more
/// than an estimate.
RealTimeState enter_real_time();

}  // namespace cremed
