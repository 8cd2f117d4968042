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

/// Keeps the heap as it is: what is freed stays for the next use, in one piece for all threads.
/// Called before any other thread starts.
void keep_heap();

/// Locks present and future memory and touches stack and heap: a page fault costs more than an
/// estimate.
RealTimeState enter_real_time();

/// Makes this thread an ordinary one: a thread begins with the priority of the one that starts it.
void leave_real_time();

}  // namespace cremed
