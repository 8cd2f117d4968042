// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <string>
#include <thread>
#include <vector>

#include "daemon/process/progress_bar.hpp"

namespace cremed {

/// make(i) of every i < count, made on `threads` threads in any order, with a progress bar. Throws
/// what make() threw for the least i.
template <typename Make>
auto made_in_parallel(const std::string& label, std::size_t count, unsigned threads,
                      const Make& make) {
  std::vector<decltype(make(count))> results(count);
  ProgressBar progress(label, count);
  std::atomic<std::size_t> next{0};
  std::vector<std::exception_ptr> failures(count);
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        results[i] = make(i);
        progress.advance();
      } catch (...) {
        failures[i] = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> others;
    for (unsigned i = 1; i < std::max(threads, 1U); ++i) {
      others.emplace_back(work);
    }
    work();
  }
  for (const std::exception_ptr& failure : failures) {
    if (failure) {
      std::rethrow_exception(failure);
    }
  }
  return results;
}

}  // namespace cremed
