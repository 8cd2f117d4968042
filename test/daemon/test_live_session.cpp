// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// On an interface that is absent, with a clock that the test moves; test/vm has buses.
#include <csignal>
#include <string>

#include <catch2/catch.hpp>

#include "daemon/live_session.hpp"
#include "test/daemon/moved_clock.hpp"
#include "test/daemon/service_manager.hpp"
#include "test/daemon/temporary_file.hpp"

using namespace cremed;
using cremed::test::Manager;
using cremed::test::stop_for;

namespace {

constexpr std::int64_t kSecondUs = 1'000'000;

Configuration one_radar() {
  Configuration configuration;
  RadarConfiguration radar;
  radar.name = "front";
  radar.interface = "absent";
  configuration.radars.push_back(radar);
  return configuration;
}

/// A session under a service manager.
class SessionBench {
 public:
  explicit SessionBench(const std::string& url, const std::string& state_file = {})
      : session_(one_radar(), url, state_file, &stop) {}

  /// What the manager hears a time later.
  std::string after(std::int64_t duration_us) {
    stop_for(duration_us);
    CHECK(session_.turn(notifier_));
    return manager_.received();
  }
  bool turn() { return session_.turn(notifier_); }

  volatile std::sig_atomic_t stop = 0;

 private:
  Manager manager_{"@cremed-test-session-" + std::to_string(::getpid())};
  ServiceNotifier notifier_;
  LiveSession session_;
};

}  // namespace

TEST_CASE("A session reports once a second, and not for each second that it did not run") {
  SessionBench bench("memq://");
  CHECK(bench.after(0) == "nothing");
  CHECK_THAT(bench.after(kSecondUs), Catch::Contains("front: absent "));
  CHECK(bench.after(kSecondUs / 2) == "nothing");
  CHECK(bench.after(kSecondUs / 2) != "nothing");
  CHECK(bench.after(10 * kSecondUs) != "nothing");
  CHECK(bench.after(kSecondUs / 2) == "nothing");
}

TEST_CASE("A session tells that LCM is not connected, and goes on") {
  SessionBench bench("file:///nowhere/cremed.lcm?mode=w");
  for (int i = 0; i < 20; ++i) {
    CHECK_THAT(bench.after(kSecondUs), Catch::Contains("LCM is not connected"));
  }
}

TEST_CASE("A session that is to publish nothing misses no LCM") {
  SessionBench bench("none");
  CHECK_THAT(bench.after(kSecondUs), !Catch::Contains("LCM"));
}

TEST_CASE(
    "A session ends when it is asked to, and keeps a state file of which it learned nothing") {
  const TemporaryFile state("kept");
  {
    SessionBench bench("none", state.path());
    CHECK(bench.after(61 * kSecondUs) != "nothing");
    bench.stop = 1;
    CHECK_FALSE(bench.turn());
  }
  CHECK(state.content() == "kept");
}
