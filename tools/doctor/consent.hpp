// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>

namespace cremed {

/// Whether the user wants a frame sent. Only a person may answer: a pipe, a file or a bus that
/// happens to be standard input says nothing.
struct Consent {
  bool is_given = false;  ///< On the command line: do not ask.
  int terminal = 0;       ///< Descriptor to ask on.
};

/// Asks, unless it was given already. Where there is no terminal, says what to give instead.
bool asks_consent(const Consent& consent, std::ostream& out);

}  // namespace cremed
