// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace cremed {

enum class Severity : std::uint8_t {
  error,    ///< No odometry while this lasts.
  warning,  ///< Degraded or untrustworthy odometry.
  note,     ///< Worth knowing.
};

/// A fault and its remedy, as text.
struct Finding {
  Severity severity = Severity::error;
  std::string what;
  std::string remedy;  ///< With the command in backquotes, if there is one.
};

/// "what; remedy"
inline std::string to_text(const Finding& finding) { return finding.what + "; " + finding.remedy; }

}  // namespace cremed
