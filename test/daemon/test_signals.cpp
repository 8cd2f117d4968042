// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <atomic>
#include <csignal>
#include <cstdint>
#include <thread>

#include <catch2/catch.hpp>
#include <pthread.h>

#include "daemon/process/signals.hpp"

using namespace cremed;

TEST_CASE("Every request of a reload is taken, at whatever instruction it comes") {
  // So many questions take far longer than a signal on its way.
  constexpr std::uint64_t kPatience = 50'000'000;
  constexpr auto relaxed = std::memory_order_relaxed;
  handle_reload_signal();
  const pthread_t asked = ::pthread_self();
  std::atomic<std::uint64_t> taken{0};
  std::atomic<std::uint64_t> asked_times{0};
  std::atomic<bool> is_over{false};
  std::uint64_t lost = 0;
  std::thread sender([&] {
    for (std::uint64_t sent = 1; sent <= 1000 && lost == 0; ++sent) {
      ::pthread_kill(asked, SIGHUP);
      const std::uint64_t limit = asked_times + kPatience;
      while (taken < sent && lost == 0) {
        lost = asked_times > limit ? sent : 0;
        std::this_thread::yield();
      }
    }
    is_over = true;
  });
  while (!is_over.load(relaxed)) {
    // Nothing in this loop but the question: the signal shall come in the middle of it.
    if (take_reload_request()) {
      taken.store(taken.load(relaxed) + 1, relaxed);
    }
    asked_times.store(asked_times.load(relaxed) + 1, relaxed);
  }
  sender.join();
  CHECK(lost == 0);
  std::signal(SIGHUP, SIG_DFL);
}
