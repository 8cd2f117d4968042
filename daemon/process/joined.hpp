// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace cremed {

/// "a, b, c": what `text` (a function or a member) makes of each.
template <typename Range, typename Text = std::identity>
std::string joined(Range&& range, const Text& text = {}, std::string_view separator = ", ") {
  std::string list;
  bool is_first = true;
  for (const auto& item : range) {
    list.append(is_first ? "" : separator).append(std::invoke(text, item));
    is_first = false;
  }
  return list;
}

}  // namespace cremed
