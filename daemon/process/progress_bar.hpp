// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace cremed {

/// A progress bar on standard error, if that is a terminal and the program no service.
class ProgressBar {
 public:
  explicit ProgressBar(std::string label, std::size_t total = 1);
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  /// Clears the line.
  ~ProgressBar();

  /// Adds one; callable from any thread.
  void advance();
  /// Shows this share, 0 to 1, a text behind it and an estimate of the time left; without a share
  /// the text only.
  void show(std::optional<double> share, const std::string& text = {}) const;

 private:
  std::string label_;
  std::size_t total_;
  std::int64_t begin_us_;
  bool is_shown_;
  std::atomic<std::size_t> done_{0};
};

}  // namespace cremed
