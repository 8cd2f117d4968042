// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>

namespace cremed {

/// The user's consent to send. It is read from a terminal only: a pipe, file or bus on standard
/// input is no consent.
struct Consent {
  bool is_given = false;  ///< On the command line: do not ask.
  int terminal = 0;       ///< Descriptor to ask on.
};

/// Asks unless consent was given. Without a terminal, prints the option to give instead.
bool asks_consent(const Consent& consent, std::ostream& out);

}  // namespace cremed
