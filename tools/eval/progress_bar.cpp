// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/progress_bar.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <unistd.h>

namespace cremed {
namespace {

constexpr std::size_t kWidth = 40;

}  // namespace

ProgressBar::ProgressBar(std::string label, std::size_t total)
    : label_(std::move(label)), total_(total), is_shown_(::isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (is_shown_) {
    ::dprintf(STDERR_FILENO, "\r\033[K");
  }
}

void ProgressBar::advance() {
  const std::size_t done = ++done_;
  const std::size_t step = std::max<std::size_t>(total_ / 200, 1);
  if (!is_shown_ || done % step != 0) {
    return;
  }
  const std::string bar(kWidth * done / total_, '#');
  ::dprintf(STDERR_FILENO, "\r%-20s [%-*s] %3zu %%", label_.c_str(), static_cast<int>(kWidth),
            bar.c_str(), 100 * done / total_);
}

}  // namespace cremed
