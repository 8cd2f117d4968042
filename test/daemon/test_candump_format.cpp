// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "daemon/configuration/bus_options.hpp"
#include "daemon/source/candump.hpp"
#include "test/daemon/candump_frames.hpp"

namespace cremed {
namespace {

std::string format(const CanFrame& frame, std::string_view interface_name = "can0") {
  return candump_line(frame, interface_name);
}

TEST_CASE("frames are written as candump writes them") {
  struct Row {
    CanFrame frame;
    const char* text;
  };
  const std::vector<Row> rows = {
      {make_frame(Kind::standard, 0x12, {0xAB, 0x01}), "012#AB01\n"},
      {make_frame(Kind::standard, 0x123), "123#\n"},
      {make_frame(Kind::extended, 0x12, {0xAB}), "00000012#AB\n"},
      {make_frame(Kind::remote, 0x123), "123#R\n"},
      {with_length(make_frame(Kind::remote, 0x123), 4), "123#R4\n"},
      {make_frame(Kind::error, 4, {0, 0x20}), "20000004#0020\n"},
      {make_frame(Kind::fd, 0x123, {0x11}), "123##011\n"},
      {make_frame(Kind::extended_fd, 0x123, {0x11}), "00000123##011\n"},
  };
  for (const Row& row : rows) {
    CHECK(format(row.frame) == kHead + row.text);
  }
}

TEST_CASE("seconds are padded to ten digits and may have twelve") {
  CanFrame frame = make_frame(Kind::standard, 0x123);
  frame.stamp_us = 7;
  CHECK(format(frame) == "(0000000000.000007) can0 123#\n");
  frame.stamp_us = 9'999'999'999'999'999;
  CHECK(format(frame) == "(9999999999.999999) can0 123#\n");
  frame.stamp_us = 10'000'000'000'000'000;
  CHECK(format(frame) == "(10000000000.000000) can0 123#\n");
  frame.stamp_us = 999'999'999'999'999'999;
  CHECK(format(frame) == "(999999999999.999999) can0 123#\n");
}

TEST_CASE("what the format cannot hold is cut") {
  CanFrame frame = make_frame(Kind::extended_fd, 0xFFFFFFFF);
  frame.length = 255;
  frame.stamp_us = std::numeric_limits<std::int64_t>::max();
  const std::string text = format(frame, "an-interface-name-that-is-too-long");
  CHECK(text == "(999999999999.999999) an-interface-na 1FFFFFFF##0" + std::string(128, '0') + "\n");
  frame = make_frame(Kind::remote, 0xFFF);
  frame.length = 200;
  frame.stamp_us = -1;
  CHECK(format(frame) == "(0000000000.000000) can0 7FF#R8\n");
}

/// Any valid frame.
CanFrame random_frame(std::mt19937_64& random) {
  const auto below = [&](std::uint64_t limit) { return random() % limit; };
  constexpr std::array<std::uint8_t, 16> fd_lengths = {0, 1,  2,  3,  4,  5,  6,  7,
                                                       8, 12, 16, 20, 24, 32, 48, 64};
  CanFrame frame = make_frame(static_cast<Kind>(below(7)), 0);
  const bool wide = frame.extended || frame.error;
  frame.id = static_cast<std::uint32_t>(below(wide ? 0x20000000 : 0x800));
  frame.length = frame.fd ? fd_lengths[below(16)] : static_cast<std::uint8_t>(below(9));
  const std::uint64_t stamp_limits[] = {10, 1'000'000, 2'000'000'000'000'000,
                                        1'000'000'000'000'000'000};
  frame.stamp_us = static_cast<std::int64_t>(below(stamp_limits[below(4)]));
  for (std::size_t i = 0; !frame.remote && i < frame.length; ++i) {
    frame.data[i] = static_cast<std::uint8_t>(below(256));
  }
  return frame;
}

TEST_CASE("a written frame is read back as it was") {
  std::mt19937_64 random(20221);
  for (int i = 0; i < 50'000; ++i) {
    const CanFrame frame = random_frame(random);
    const std::string name(1 + random() % kMaxInterfaceName, 'c');
    const std::string text = format(frame, name);
    CAPTURE(text);
    const CandumpLine line = parse_candump_line(text);
    REQUIRE(line.status == CandumpStatus::frame);
    REQUIRE(line.frame == frame);
    REQUIRE(line.interface_name == name);
  }
}

}  // namespace
}  // namespace cremed
