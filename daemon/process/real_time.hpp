// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace cremed {

/// Whether the process can rely on being run in time. The priority is the service manager's to set
/// (CPUSchedulingPolicy=fifo); we only look.
struct RealTimeState {
  bool has_priority = false;  ///< SCHED_FIFO or SCHED_RR.
  int priority = 0;
  bool memory_locked = false;

  /// What is missing and how to get it; empty if nothing is.
  [[nodiscard]] std::string problem() const;
};

/// Locks all memory, present and future, and touches the stack the hot path will use: a page fault
/// costs more than an estimate.
RealTimeState enter_real_time();

}  // namespace cremed
