// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace cremed {

/// Called first in every main. Replaces closed standard streams by /dev/null, so that no file or
/// socket becomes one of them; writing results to a closed standard output fails. A file over its
/// size limit is a failed write, not a signal. Makes the standard streams plain.
void set_up_process();

/// Called last with the exit status, which it returns; 1 instead of 0, and a message, if standard
/// output was not written completely.
int finish_process(int status);

}  // namespace cremed
