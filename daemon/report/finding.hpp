// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace cremed {

enum class Severity : std::uint8_t {
  error,    ///< There is no odometry while this lasts.
  warning,  ///< Odometry suffers, or is not to be trusted.
  note,     ///< Worth knowing.
};

/// Something that is wrong and how to mend it, for people.
struct Finding {
  Severity severity = Severity::error;
  std::string what;
  std::string remedy;  ///< With the command, in backquotes, where there is one.
};

/// "what; remedy"
std::string to_text(const Finding& finding);

}  // namespace cremed
