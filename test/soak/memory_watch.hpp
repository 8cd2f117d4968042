// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace cremed::soak {

struct MemoryUse {
  std::size_t resident_kib = 0;   ///< VmRSS
  std::size_t allocated_kib = 0;  ///< In malloc's blocks in use.
};

MemoryUse memory_use();

}  // namespace cremed::soak
