// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/configuration/diagnostics.hpp"

#include <algorithm>

#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

constexpr std::size_t kMaxShown = 20;

}  // namespace

void Diagnostics::add(std::size_t line, std::string_view key, std::string_view problem) {
  entries_.push_back({line, concat({key, ": ", problem})});
}

std::string Diagnostics::text() const {
  std::vector<Entry> sorted = entries_;
  std::ranges::stable_sort(sorted, {}, &Entry::line);
  std::string text;
  for (std::size_t i = 0; i < std::min(sorted.size(), kMaxShown); ++i) {
    text += i == 0 ? "" : "\n";
    text += concat({file_name_, ":", std::to_string(sorted[i].line), ": ", sorted[i].message});
  }
  if (sorted.size() > kMaxShown) {
    text += concat({"\n", file_name_, ": ", std::to_string(sorted.size() - kMaxShown), " more"});
  }
  return text;
}

}  // namespace cremed
