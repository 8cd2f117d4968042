// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <string>

namespace cremed {

/// Logs each condition once when it begins and once when it ends, however often it is looked at.
class ConditionLog {
 public:
  /// `kind` numbers what is wrong with `subject`, 0: nothing. `text` is asked for when the kind is
  /// another than last time.
  void update(const std::string& subject, int kind, const std::function<std::string()>& text);

 private:
  std::map<std::string, int> kinds_;
};

}  // namespace cremed
