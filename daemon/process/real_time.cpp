// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/process/real_time.hpp"

#include <array>
#include <cstddef>

#include <malloc.h>
#include <sched.h>
#include <sys/mman.h>

namespace cremed {
namespace {

/// The deepest measured use is below 64 KiB; Eigen may take 128 KiB.
constexpr std::size_t kStackBytes = std::size_t{256} * 1024;

void touch_stack() {
  std::array<volatile char, kStackBytes> stack;
  for (std::size_t i = 0; i < stack.size(); i += 1024) {
    stack[i] = 0;
  }
}

}  // namespace

std::string RealTimeState::problem() const {
  std::string text;
  if (!has_priority) {
    text =
        "no real-time priority (set CPUSchedulingPolicy=fifo in the unit, or start with chrt -f "
        "20)";
  }
  if (!memory_locked) {
    text += text.empty() ? "" : "; ";
    text += "memory is not locked (set LimitMEMLOCK=128M in the unit, or ulimit -l 131072)";
  }
  return text;
}

RealTimeState enter_real_time() {
  RealTimeState state;
  const int policy = ::sched_getscheduler(0) & ~SCHED_RESET_ON_FORK;
  sched_param parameters{};
  state.has_priority =
      (policy == SCHED_FIFO || policy == SCHED_RR) && ::sched_getparam(0, &parameters) == 0;
  state.priority = parameters.sched_priority;
  // A separate arena of another thread would lock another 64 MiB.
  ::mallopt(M_ARENA_MAX, 1);
  state.memory_locked = ::mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
  touch_stack();
  return state;
}

}  // namespace cremed
