// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>

#include "daemon/process/descriptor.hpp"

namespace cremed {

/// Notifies the service manager (sd_notify(3): datagrams to $NOTIFY_SOCKET). Without that socket
/// every call does nothing. Never blocks, never fails.
class ServiceNotifier {
 public:
  /// Reads NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID.
  ServiceNotifier();

  void ready() const { send("READY=1"); }
  void stopping() const { send("STOPPING=1"); }
  /// ready() follows when it is done.
  void reloading() const;
  /// One line of text.
  void status(std::string_view text) const;
  void watchdog() const { send("WATCHDOG=1"); }

  /// Period of watchdog(): half of the manager's limit; 0: no watchdog.
  [[nodiscard]] std::int64_t watchdog_period_us() const { return watchdog_period_us_; }

 private:
  void send(std::string_view message) const;

  Descriptor descriptor_;
  std::int64_t watchdog_period_us_ = 0;
};

}  // namespace cremed
