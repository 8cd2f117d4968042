// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "test/soak/memory_watch.hpp"

#include <fstream>
#include <string>

#include <malloc.h>

namespace cremed::soak {

MemoryUse memory_use() {
  const struct mallinfo2 heap = ::mallinfo2();
  MemoryUse use;
  use.allocated_kib = (heap.uordblks + heap.hblkhd) / 1024;
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word == "VmRSS:") {
      status >> use.resident_kib;
      break;
    }
  }
  return use;
}

}  // namespace cremed::soak
