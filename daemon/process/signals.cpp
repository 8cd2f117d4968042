// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/process/signals.hpp"

#include <cerrno>

#include <poll.h>

namespace cremed {
namespace {

volatile std::sig_atomic_t stop_was_requested = 0;
volatile std::sig_atomic_t reload_requested = 0;

void request_stop(int signal) { stop_was_requested = signal; }
void request_reload(int /*signal*/) { reload_requested = 1; }

/// Without SA_RESTART: system calls in progress return.
void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  ::sigaction(signal, &action, nullptr);
}

}  // namespace

const volatile std::sig_atomic_t* handle_stop_signals() {
  handle(SIGINT, request_stop);
  handle(SIGTERM, request_stop);
  return &stop_was_requested;
}

void stop_at_hangup() {
  struct sigaction before {};
  if (::sigaction(SIGHUP, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) {
    handle(SIGHUP, request_stop);
  }
}

bool stop_requested() { return stop_was_requested != 0; }

bool wait_for_room(int descriptor) {
  pollfd output{descriptor, POLLOUT, 0};
  while (::poll(&output, 1, kStopPollMs) <= 0) {
    if (stop_requested()) {
      errno = EINTR;
      return false;
    }
  }
  return true;
}

void handle_reload_signal() { handle(SIGHUP, request_reload); }

bool take_reload_request() {
  if (reload_requested == 0) {
    return false;  // Clearing it all the same would lose a signal that comes meanwhile.
  }
  reload_requested = 0;
  return true;
}

SignalsBlocked::SignalsBlocked() {
  sigset_t all;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before_);
}

SignalsBlocked::~SignalsBlocked() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

}  // namespace cremed
