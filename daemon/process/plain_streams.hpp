// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace cremed {

/// From now on all that goes through std::cout, std::cerr, stdout and stderr is plain_text(). For
/// programs that print what they read; called in main, before anything is printed.
void make_standard_streams_plain();

}  // namespace cremed
