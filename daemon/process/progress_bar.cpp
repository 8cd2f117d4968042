// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/process/progress_bar.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include "daemon/process/clocks.hpp"

namespace cremed {
namespace {

constexpr std::size_t kWidth = 40;

/// A service is told to notify systemd, whatever its standard error is.
bool is_terminal() {
  return ::isatty(STDERR_FILENO) == 1 && std::getenv("NOTIFY_SOCKET") == nullptr;
}

/// " [####    ]  50 %"
std::string bar(double share) {
  const std::string done(static_cast<std::size_t>(share * kWidth), '#');
  return fmt::format(" [{:{}}] {:3} %", done, kWidth, static_cast<int>(100.0 * share));
}

/// ", 12 s left", if the rest takes as long as what is done; empty before anything is.
std::string rest(double share, std::int64_t begin_us) {
  const double taken_s = static_cast<double>(monotonic_us() - begin_us) * 1e-6;
  return share > 0.0 ? fmt::format(", {:.0f} s left", taken_s * (1.0 - share) / share) : "";
}

}  // namespace

ProgressBar::ProgressBar(std::string label, std::size_t total)
    : label_(std::move(label)),
      total_(total),
      begin_us_(monotonic_us()),
      is_shown_(is_terminal()) {}

ProgressBar::~ProgressBar() {
  if (is_shown_) {
    ::dprintf(STDERR_FILENO, "\r\033[K");
  }
}

void ProgressBar::advance() {
  const std::size_t done = ++done_;
  const std::size_t step = std::max<std::size_t>(total_ / 200, 1);
  if (done % step == 0) {
    show(static_cast<double>(done) / static_cast<double>(total_));
  }
}

void ProgressBar::show(std::optional<double> share, const std::string& text) const {
  if (is_shown_) {
    ::dprintf(STDERR_FILENO, "\r%s%s%s%s%s\033[K", label_.c_str(), share ? bar(*share).c_str() : "",
              text.empty() ? "" : " ", text.c_str(), share ? rest(*share, begin_us_).c_str() : "");
  }
}

}  // namespace cremed
