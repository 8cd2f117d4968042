// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>
#include <string>

#include <catch2/catch.hpp>
#include <unistd.h>

#include "daemon/report/service_notifier.hpp"
#include "test/daemon/service_manager.hpp"

using namespace cremed;
using cremed::test::Manager;

TEST_CASE("The manager hears everything, by a path or an abstract name") {
  const std::string name = GENERATE(std::string("@cremed-test-") + std::to_string(::getpid()),
                                    "/tmp/cremed-test-" + std::to_string(::getpid()));
  const Manager manager(name);
  const ServiceNotifier notifier;
  notifier.ready();
  CHECK(manager.received() == "READY=1");
  notifier.status("front: 14 scans/s");
  CHECK(manager.received() == "STATUS=front: 14 scans/s");
  notifier.watchdog();
  CHECK(manager.received() == "WATCHDOG=1");
  notifier.reloading();
  CHECK_THAT(manager.received(), Catch::StartsWith("RELOADING=1\nMONOTONIC_USEC="));
  notifier.stopping();
  CHECK(manager.received() == "STOPPING=1");
}

TEST_CASE("The watchdog wants half its time, and only from the process it watches") {
  const Manager manager("@cremed-test-watchdog-" + std::to_string(::getpid()));
  CHECK(ServiceNotifier().watchdog_period_us() == 0);
  ::setenv("WATCHDOG_USEC", "2000000", 1);
  CHECK(ServiceNotifier().watchdog_period_us() == 1'000'000);
  ::setenv("WATCHDOG_PID", std::to_string(::getpid()).c_str(), 1);
  CHECK(ServiceNotifier().watchdog_period_us() == 1'000'000);
  ::setenv("WATCHDOG_PID", "1", 1);
  CHECK(ServiceNotifier().watchdog_period_us() == 0);
}

TEST_CASE("Without a manager, or with one that is gone or does not read, nothing happens") {
  ServiceNotifier().ready();
  {
    const Manager manager("@cremed-test-deaf-" + std::to_string(::getpid()));
    const ServiceNotifier notifier;
    for (int i = 0; i < 10'000; ++i) {
      notifier.watchdog();  // Far more than its queue holds.
    }
  }
  ::setenv("NOTIFY_SOCKET", "relative/path", 1);
  ServiceNotifier().ready();
  ::unsetenv("NOTIFY_SOCKET");
}

TEST_CASE("A status is whole, unless systemd would ignore a message of its size") {
  const Manager manager("@cremed-test-long-" + std::to_string(::getpid()));
  const std::string radars(16 * 160, 'x');
  ServiceNotifier().status(radars);
  CHECK(manager.received() == "STATUS=" + radars);
  ServiceNotifier().status(std::string(5000, 'x'));
  const std::string text = manager.received();
  CHECK(text.size() == 4096);
  CHECK_THAT(text, Catch::StartsWith("STATUS=xxx"));
}
