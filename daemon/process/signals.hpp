// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>

namespace cremed {

/// SIGINT and SIGTERM request a stop: they set the returned flag, to their number, and interrupt a
/// read, sleep or poll in progress.
const volatile std::sig_atomic_t* handle_stop_signals();
/// The same for SIGHUP (end of the terminal), unless it is ignored (nohup).
void stop_at_hangup();
/// Whether a stop was requested.
bool stop_requested();
/// A signal just before a system call does not interrupt it: wait at most so long, then ask.
inline constexpr int kStopPollMs = 100;

/// Waits until `descriptor` can be written to; false, with errno, if a stop was requested first.
bool wait_for_room(int descriptor);

/// SIGHUP requests a reload of the configuration.
void handle_reload_signal();
/// Whether a reload was requested since the last call that returned true.
bool take_reload_request();

/// Blocks signals in this thread, and in threads started meanwhile, during its lifetime.
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
