// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <catch2/catch.hpp>
#include <malloc.h>
#include <sched.h>
#include <unistd.h>

#include "daemon/output/learned_writer.hpp"
#include "daemon/process/real_time.hpp"
#include "test/daemon/temporary_file.hpp"

using namespace cremed;

namespace {

bool has_heap_of_its_own() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return false;
#elif defined(__has_feature)
  return !__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer);
#else
  return true;
#endif
}

/// Scheduling policies of the threads other than this one.
std::vector<int> policies_of_others() {
  std::vector<int> policies;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) {
    const int id = std::stoi(thread.path().filename());
    if (id != ::gettid()) {
      policies.push_back(::sched_getscheduler(id));
    }
  }
  return policies;
}

}  // namespace

TEST_CASE("The heap stays as it is, whatever the report of a second takes and frees") {
  if (!has_heap_of_its_own()) {
    return;
  }
  keep_heap();
  enter_real_time();
  const void* const end = ::sbrk(0);
  for (const std::size_t bytes : {100U, 10'000U, 200'000U, 500'000U, 100U, 200'000U}) {
    CAPTURE(bytes);
    const std::string text(bytes, 'x');
    CHECK(::mallinfo2().hblks == 0);
    CHECK(::sbrk(0) == end);
  }
  CHECK(::sbrk(0) == end);
}

TEST_CASE("The thread that writes to the disk has no real-time priority") {
  // A sanitizer's own thread begins with the first one: here, without the priority.
  std::thread([] {}).join();
  const sched_param priority{.sched_priority = 1};
  if (::sched_setscheduler(0, SCHED_FIFO, &priority) != 0) {
    WARN("skipped: no permission for SCHED_FIFO");
    return;
  }
  {
    const TemporaryFile file;
    LearnedWriter writer(file.path());
    while (!writer.offer("x") || file.content() != "x") {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const std::vector<int> policies = policies_of_others();
    CHECK_FALSE(policies.empty());
    CHECK(policies == std::vector<int>(policies.size(), SCHED_OTHER));
  }
  const sched_param ordinary{};
  ::sched_setscheduler(0, SCHED_OTHER, &ordinary);
}
