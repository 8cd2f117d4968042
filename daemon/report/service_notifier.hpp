// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>

namespace cremed {

/// Tells the service manager how we are (sd_notify(3): datagrams to $NOTIFY_SOCKET). Without such a
/// socket every call does nothing. Never waits, never fails.
class ServiceNotifier {
 public:
  /// From NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID.
  ServiceNotifier();
  ~ServiceNotifier();
  ServiceNotifier(const ServiceNotifier&) = delete;
  ServiceNotifier& operator=(const ServiceNotifier&) = delete;

  void ready() const { send("READY=1"); }
  void stopping() const { send("STOPPING=1"); }
  /// Followed by ready() when done.
  void reloading() const;
  /// One line for people.
  void status(std::string_view text) const;
  void watchdog() const { send("WATCHDOG=1"); }

  /// How often watchdog() is to be called: half of what the manager allows; 0: it does not watch.
  [[nodiscard]] std::int64_t watchdog_period_us() const { return watchdog_period_us_; }

 private:
  void send(std::string_view message) const;

  int descriptor_ = -1;
  std::int64_t watchdog_period_us_ = 0;
};

}  // namespace cremed
