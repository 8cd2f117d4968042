// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "daemon/source/stamp_merge.hpp"

using namespace cremed;

namespace {

constexpr std::size_t kCapacity = 8;

ReceivedFrame frame(std::int64_t stamp_us, std::size_t lane, std::uint32_t id) {
  ReceivedFrame received;
  received.received_us = stamp_us;
  received.frame.interface = static_cast<std::uint8_t>(lane);
  received.frame.id = id;
  return received;
}

/// A lane of the kernel: frames become readable in order, each some time after its stamp.
struct Bus {
  std::vector<ReceivedFrame> frames;
  std::vector<std::int64_t> readable_us;
  std::size_t read = 0;
};

std::vector<Bus> draw_buses(std::mt19937& random, std::size_t count, std::int64_t delay_us) {
  std::vector<Bus> buses(count);
  for (std::size_t lane = 0; lane < count; ++lane) {
    std::int64_t stamp_us = 0;
    const int mean_us = std::uniform_int_distribution(1, 400)(random);
    for (std::uint32_t id = 0; stamp_us < 20'000; ++id) {
      stamp_us += std::uniform_int_distribution(0, 2 * mean_us)(random);
      buses[lane].frames.push_back(frame(stamp_us, lane, id));
      buses[lane].readable_us.push_back(
          stamp_us + std::uniform_int_distribution<std::int64_t>(0, delay_us)(random));
    }
  }
  return buses;
}

/// By stamp, then by lane; frames of one lane keep their order.
std::vector<ReceivedFrame> sorted(const std::vector<Bus>& buses) {
  std::vector<ReceivedFrame> all;
  for (const Bus& bus : buses) {
    all.insert(all.end(), bus.frames.begin(), bus.frames.end());
  }
  std::ranges::stable_sort(
      all, [](const auto& a, const auto& b) { return a.received_us < b.received_us; });
  return all;
}

/// Reads up to a batch, as LiveSource does.
void read(Bus& bus, std::size_t lane, std::int64_t now_us, std::int64_t margin_us,
          StampMerge& merge) {
  std::size_t count = 0;
  while (bus.read < bus.frames.size() && bus.readable_us[bus.read] <= now_us && count < kCapacity) {
    merge.push(lane, bus.frames[bus.read++]);
    ++count;
  }
  if (count < kCapacity) {
    merge.set_read_until(lane, now_us - margin_us);
  }
}

}  // namespace

TEST_CASE("However the reader is held up, frames come in order of stamp, then of lane") {
  constexpr std::int64_t kDelayUs = 300;
  std::mt19937 random(GENERATE(range(1U, 40U)));
  std::vector<Bus> buses =
      draw_buses(random, std::uniform_int_distribution<std::size_t>(1, 5)(random), kDelayUs);
  const std::int64_t longest_pause_us = GENERATE(20, 4000);
  StampMerge merge(buses.size(), kCapacity);
  std::vector<ReceivedFrame> out;
  for (std::int64_t now_us = 0; now_us < 40'000;
       now_us += std::uniform_int_distribution<std::int64_t>(1, longest_pause_us)(random)) {
    while (merge.oldest() && !merge.awaited()) {
      const std::size_t lane = *merge.oldest();
      out.push_back(merge.front(lane));
      merge.pop(lane);
    }
    for (std::size_t lane = 0; lane < buses.size(); ++lane) {
      if (!merge.has_frames(lane)) {
        read(buses[lane], lane, now_us, kDelayUs + 1, merge);
      }
    }
  }
  const std::vector<ReceivedFrame> expected = sorted(buses);
  for (std::size_t i = 0; i < out.size(); ++i) {
    REQUIRE(out[i].received_us == expected[i].received_us);
    REQUIRE(out[i].frame.interface == expected[i].frame.interface);
    REQUIRE(out[i].frame.id == expected[i].frame.id);
  }
  CHECK(out.size() + merge.size() <= expected.size());
  CHECK(out.size() > 20);
}

TEST_CASE("A lane that is known to be read far enough is not awaited") {
  StampMerge merge(2, kCapacity);
  CHECK_FALSE(merge.oldest());
  CHECK_FALSE(merge.awaited());
  merge.push(0, frame(100, 0, 1));
  CHECK(merge.oldest() == std::size_t{0});
  CHECK(merge.awaited() == std::size_t{1});
  merge.set_read_until(1, 99);
  CHECK(merge.awaited() == std::size_t{1});
  merge.set_read_until(1, 100);  // A later frame of lane 1 at 100 comes after lane 0.
  CHECK_FALSE(merge.awaited());
  merge.pop(0);
  merge.push(1, frame(100, 1, 1));
  merge.set_read_until(0, 100);  // A later frame of lane 0 at 100 comes before lane 1.
  CHECK(merge.awaited() == std::size_t{0});
  merge.set_read_until(0, 101);
  CHECK_FALSE(merge.awaited());
}

TEST_CASE("Frames of one lane keep their order, also where its stamps run backwards") {
  StampMerge merge(2, kCapacity);
  merge.push(0, frame(500, 0, 1));
  merge.push(0, frame(100, 0, 2));
  merge.push(1, frame(300, 1, 3));
  std::vector<std::uint32_t> ids;
  while (const auto lane = merge.oldest()) {
    ids.push_back(merge.front(*lane).frame.id);
    merge.pop(*lane);
  }
  CHECK(ids == std::vector<std::uint32_t>{3, 1, 2});
}

TEST_CASE("A lane is emptied by itself") {
  StampMerge merge(2, kCapacity);
  for (std::uint32_t id = 0; id < kCapacity; ++id) {
    merge.push(0, frame(id, 0, id));
  }
  merge.push(1, frame(1, 1, 0));
  CHECK(merge.is_full(0));
  CHECK(merge.clear(0) == kCapacity);
  CHECK_FALSE(merge.has_frames(0));
  CHECK(merge.size() == 1);
  CHECK(merge.oldest() == std::size_t{1});
}
