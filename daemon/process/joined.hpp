// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

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

/// Likewise, of those that are listed. (Clang 14 does not compile the views of GCC 12's library.)
template <typename Range, typename Listed, typename Text>
std::string joined_if(const Range& range, const Listed& is_listed, const Text& text) {
  std::vector<std::string> listed;
  for (const auto& item : range) {
    if (is_listed(item)) {
      listed.emplace_back(std::invoke(text, item));
    }
  }
  return joined(listed);
}

}  // namespace cremed
