// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/report/condition_log.hpp"

#include <spdlog/spdlog.h>

namespace cremed {

void ConditionLog::update(const std::string& subject, int kind,
                          const std::function<std::string()>& text) {
  int& last = kinds_[subject];
  if (kind == last) {
    return;
  }
  last = kind;
  if (kind == 0) {
    spdlog::info("{}: good again", subject);
  } else {
    spdlog::warn("{}: {}", subject, text());
  }
}

}  // namespace cremed
