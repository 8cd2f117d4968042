// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <string>

namespace cremed {

/// A progress bar on standard error, if that is a terminal.
class ProgressBar {
 public:
  ProgressBar(std::string label, std::size_t total);
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  /// Clears the line.
  ~ProgressBar();

  /// Adds one; callable from any thread.
  void advance();

 private:
  std::string label_;
  std::size_t total_;
  bool is_shown_;
  std::atomic<std::size_t> done_{0};
};

}  // namespace cremed
