// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "daemon/scan_queue.hpp"

using namespace cremed;

namespace {

constexpr std::int64_t kCycleUs = 72'000;

bool awaits_nothing(const ScanQueue::Scan& /*scan*/) { return false; }
bool awaits(const ScanQueue::Scan& /*scan*/) { return true; }

/// A scan is complete some time after its stamp.
struct Arrival {
  ScanQueue::Scan scan;
  std::int64_t complete_us;
};

/// Of radars that do not know of each other, in the order in which their scans are complete.
std::vector<Arrival> draw_drive(std::mt19937& random, std::size_t radars, std::int64_t longest_us) {
  std::uniform_int_distribution<std::int64_t> lasts(1, longest_us);
  std::vector<Arrival> arrivals;
  for (std::size_t radar = 0; radar < radars; ++radar) {
    const std::int64_t first_us = std::uniform_int_distribution<std::int64_t>(0, kCycleUs)(random);
    for (std::int64_t i = 0; i < 50; ++i) {
      const std::int64_t stamp_us = first_us + i * kCycleUs;
      arrivals.push_back({{radar, stamp_us}, stamp_us + lasts(random)});
    }
  }
  std::ranges::sort(arrivals,
                    [](const auto& a, const auto& b) { return a.complete_us < b.complete_us; });
  return arrivals;
}

/// The stamps in the order in which the queue gives them.
std::vector<std::int64_t> in_order_of_use(const std::vector<Arrival>& arrivals,
                                          std::size_t radars) {
  ScanQueue queue(radars);
  std::vector<std::int64_t> used;
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    const std::int64_t now_us = arrivals[i].complete_us;
    const auto is_awaiting = [&](const ScanQueue::Scan& scan) {
      return std::any_of(arrivals.begin() + static_cast<std::ptrdiff_t>(i) + 1, arrivals.end(),
                         [&](const Arrival& open) { return open.scan.stamp_us < scan.stamp_us; });
    };
    queue.push(arrivals[i].scan);
    while (const auto scan = queue.pop(now_us, is_awaiting)) {
      used.push_back(scan->stamp_us);
    }
  }
  while (const auto scan = queue.pop()) {
    used.push_back(scan->stamp_us);
  }
  return used;
}

}  // namespace

TEST_CASE("However long scans take, none is used before one that began earlier") {
  std::mt19937 random(GENERATE(range(1U, 30U)));
  const std::size_t radars = std::uniform_int_distribution<std::size_t>(1, 5)(random);
  const auto used = in_order_of_use(draw_drive(random, radars, kCycleUs - 1), radars);
  CHECK(used.size() == 50 * radars);
  CHECK(std::ranges::is_sorted(used));
}

TEST_CASE("A scan that waits for none is used at once, an awaited one first") {
  ScanQueue queue(2);
  CHECK_FALSE(queue.pop(0, awaits_nothing));
  queue.push({1, 2'000});
  CHECK_FALSE(queue.pop(2'100, awaits));
  queue.push({0, 1'000});
  CHECK(queue.pop(2'200, awaits_nothing)->radar == 0);
  CHECK_FALSE(queue.holds(0));
  CHECK(queue.holds(1));
  CHECK(queue.pop(2'200, awaits_nothing)->stamp_us == 2'000);
  CHECK_FALSE(queue.pop(2'200, awaits_nothing));
}

TEST_CASE("No scan waits longer than a scan can last") {
  ScanQueue queue(2);
  CHECK_FALSE(queue.deadline_us());
  queue.push({1, 9'000});
  queue.push({0, 10'000});
  REQUIRE(queue.deadline_us() == 9'000 + ScanQueue::kLongestWaitUs);
  CHECK_FALSE(queue.pop(*queue.deadline_us(), awaits));
  CHECK(queue.pop(*queue.deadline_us() + 1, awaits)->radar == 1);
  CHECK_FALSE(queue.pop(9'000 + ScanQueue::kLongestWaitUs + 1, awaits));
}

TEST_CASE("Of one stamp the first radar is first; a cleared queue holds none") {
  ScanQueue queue(3);
  queue.push({2, 5});
  queue.push({1, 5});
  CHECK(queue.pop()->radar == 1);
  queue.clear();
  CHECK_FALSE(queue.holds(2));
  CHECK_FALSE(queue.pop());
}
