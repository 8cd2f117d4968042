// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>

namespace cremed {

/// SIGINT and SIGTERM from now on ask to stop: they set what is returned, and end a read, a sleep
/// or a poll in progress.
const volatile std::sig_atomic_t* handle_stop_signals();

/// SIGHUP from now on asks to read the configuration again.
void handle_reload_signal();
/// Was it asked for since the last call?
bool take_reload_request();

}  // namespace cremed
