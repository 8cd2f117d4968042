// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace cremed {

/// Passes all output of std::cout, std::cerr, stdout and stderr through plain_text(), because
/// programs print what they read. To be called before anything is printed.
void make_standard_streams_plain();

}  // namespace cremed
