// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/process/real_time.hpp"

#include <array>
#include <cstddef>
#include <memory>

#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

namespace cremed {
namespace {

/// The deepest measured use is below 64 KiB; Eigen may take 128 KiB.
constexpr std::size_t kStackBytes = std::size_t{256} * 1024;

/// For the texts of the report, once a second, and the largest message.
constexpr std::size_t kHeapReserveBytes = std::size_t{1024} * 1024;

void touch_stack() {
  std::array<volatile char, kStackBytes> stack;
  for (std::size_t i = 0; i < stack.size(); i += 1024) {
    stack[i] = 0;
  }
}

/// The memory that is freed here serves every later allocation.
void touch_heap() {
  const std::unique_ptr<volatile char[]> heap(new volatile char[kHeapReserveBytes]);
  for (std::size_t i = 0; i < kHeapReserveBytes; i += 1024) {
    heap[i] = 0;
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

void keep_heap() {
  // A separate arena of another thread would lock another 64 MiB.
  ::mallopt(M_ARENA_MAX, 1);
  ::mallopt(M_TRIM_THRESHOLD, -1);
  ::mallopt(M_MMAP_MAX, 0);
}

RealTimeState enter_real_time() {
  RealTimeState state;
  const int policy = ::sched_getscheduler(0) & ~SCHED_RESET_ON_FORK;
  sched_param parameters{};
  state.has_priority =
      (policy == SCHED_FIFO || policy == SCHED_RR) && ::sched_getparam(0, &parameters) == 0;
  state.priority = parameters.sched_priority;
  state.memory_locked = ::mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
  touch_stack();
  touch_heap();
  return state;
}

void leave_real_time() {
  const sched_param ordinary{};
  // Refused under the unit, whose CPUSchedulingResetOnFork has done it already.
  ::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &ordinary);
}

}  // namespace cremed
