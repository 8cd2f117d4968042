// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace cremed {

/// Called first in every main. Opens /dev/null in place of closed standard streams: otherwise the
/// next file or socket would become one of them. Nothing can be read from these, and writing
/// results to a standard output that was closed fails. A file over its size limit is a failed
/// write, not a signal.
void set_up_process();

/// Called last with the exit status, which it returns; 1 in place of 0, and a message, if standard
/// output did not take all.
int finish_process(int status);

}  // namespace cremed
