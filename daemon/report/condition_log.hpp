// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <string>

namespace cremed {

/// Logs each condition once when it begins and once when it ends.
class ConditionLog {
 public:
  /// `kind` identifies the fault of `subject`, 0: none. `text` is called when the kind has changed.
  void update(const std::string& subject, int kind, const std::function<std::string()>& text);
  /// Of a fault of one kind, with one text.
  void update(const std::string& subject, bool is_faulty, const char* text) {
    update(subject, is_faulty ? 1 : 0, [text] { return text; });
  }

 private:
  std::map<std::string, int> kinds_;
};

}  // namespace cremed
