// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>

namespace cremed {

/// SIGINT and SIGTERM from now on ask to stop: they set what is returned, and end a read, a sleep
/// or a poll in progress.
const volatile std::sig_atomic_t* handle_stop_signals();
/// The same for SIGHUP, the end of the terminal, unless it is ignored (nohup).
void stop_at_hangup();
/// Whether one of them came.
bool stop_requested();

/// SIGHUP from now on asks to read the configuration again.
void handle_reload_signal();
/// Was it asked for since the last call?
bool take_reload_request();

/// No signal comes to this thread, nor to threads begun, while there is one.
class SignalsBlocked {
 public:
  SignalsBlocked();
  ~SignalsBlocked();
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_{};
};

}  // namespace cremed
