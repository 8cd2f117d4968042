// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace cremed {

/// Calls body(i) once for every i < count on `threads` threads, in any order. The body must not
/// throw.
template <typename Body>
void parallel_for(std::size_t count, unsigned threads, const Body& body) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      body(i);
    }
  };
  std::vector<std::jthread> others;
  for (unsigned i = 1; i < std::max(threads, 1U); ++i) {
    others.emplace_back(work);
  }
  work();
}

}  // namespace cremed
