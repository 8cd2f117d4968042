// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "daemon/source/candump.hpp"
#include "test/daemon/candump_frames.hpp"

namespace cremed {
namespace {

struct GoodLine {
  std::string text;  // Without stamp and interface.
  CanFrame frame;
};

const GoodLine kGoodLines[] = {
    {"123#", make_frame(Kind::standard, 0x123)},
    {"7FF#00", make_frame(Kind::standard, 0x7FF, {0})},
    {"123#1122334455667788",
     make_frame(Kind::standard, 0x123, {0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88})},
    {"1a3#aBcDeF", make_frame(Kind::standard, 0x1A3, {0xAB, 0xCD, 0xEF})},
    {"123#11.2233.44", make_frame(Kind::standard, 0x123, {0x11, 0x22, 0x33, 0x44})},
    {"123#1122334455667788_E",
     make_frame(Kind::standard, 0x123, {0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88})},
    {"12345678#112233", make_frame(Kind::extended, 0x12345678, {0x11, 0x22, 0x33})},
    {"1FFFFFFF#", make_frame(Kind::extended, 0x1FFFFFFF)},
    {"00000123#01", make_frame(Kind::extended, 0x123, {1})},
    {"123#R", make_frame(Kind::remote, 0x123)},
    {"123#r0", make_frame(Kind::remote, 0x123)},
    {"123#R4", with_length(make_frame(Kind::remote, 0x123), 4)},
    {"123#R8_9", with_length(make_frame(Kind::remote, 0x123), 8)},
    {"12345678#R5", with_length(make_frame(Kind::extended_remote, 0x12345678), 5)},
    {"20000004#0020000000000000", make_frame(Kind::error, 4, {0, 0x20, 0, 0, 0, 0, 0, 0})},
    {"3FFFFFFF#", make_frame(Kind::error, 0x1FFFFFFF)},
    {"123##0", make_frame(Kind::fd, 0x123)},
    {"123##F112233", make_frame(Kind::fd, 0x123, {0x11, 0x22, 0x33})},
    {"123##5.11.22", make_frame(Kind::fd, 0x123, {0x11, 0x22})},
    {"123##1000102030405060708090A0B",
     make_frame(Kind::fd, 0x123, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11})},
    {"12345678##011", make_frame(Kind::extended_fd, 0x12345678, {0x11})},
};

TEST_CASE("frames of every kind are read, whatever the line end and direction mark") {
  const std::string tail = GENERATE("", "\n", "\r\n", "\r", " R", " T\n", " R \r\n", "  ");
  for (const GoodLine& good : kGoodLines) {
    const std::string text = std::string(kHead).append(good.text).append(tail);
    CAPTURE(text);
    const CandumpLine line = parse_candump_line(text);
    REQUIRE(line.status == CandumpStatus::frame);
    CHECK(line.frame == good.frame);
    CHECK(line.interface_name == "can0");
    CHECK(line.error.empty());
  }
}

TEST_CASE("stamps become microseconds") {
  struct Row {
    const char* text;
    std::int64_t stamp_us;
  };
  const std::vector<Row> rows = {
      {"(0.000000) can0 123#", 0},
      {"(0.000001) can0 123#", 1},
      {"(0000000000.000000) can0 123#", 0},
      {"(1436509052.249713) can0 123#", 1436509052249713},
      {"(1436509052.249713999) can0 123#", 1436509052249713},  // Down, never up.
      {"(1436509052.999999999) can0 123#", 1436509052999999},
      {"(12.345678000) can0 123#", 12345678},
      {"(999999999999.999999) can0 123#", 999999999999999999},
  };
  for (const Row& row : rows) {
    CAPTURE(row.text);
    const CandumpLine line = parse_candump_line(row.text);
    REQUIRE(line.status == CandumpStatus::frame);
    CHECK(line.frame.stamp_us == row.stamp_us);
  }
}

TEST_CASE("interface names may be padded and up to 15 characters long") {
  CHECK(parse_candump_line("(1.000000)   vcan0   123#").interface_name == "vcan0");
  CHECK(parse_candump_line("(1.000000)\tcan-left.1\t123#").interface_name == "can-left.1");
  CHECK(parse_candump_line("(1.000000) abcdefghijklmno 123#").interface_name == "abcdefghijklmno");
}

struct BadLine {
  std::string text;
  const char* right;  // Part of the message that states the correct form.
};

const BadLine kBadLines[] = {
    {"(", "(seconds.fraction)"},
    {"()", "(seconds.fraction)"},
    {"(1436509052) can0 123#", "(seconds.fraction)"},
    {"(.249713) can0 123#", "(seconds.fraction)"},
    {"(-1.249713) can0 123#", "(seconds.fraction)"},
    {"(1,249713) can0 123#", "(seconds.fraction)"},
    {"( 1.249713) can0 123#", "(seconds.fraction)"},
    {"(1.249713 can0 123#", "(seconds.fraction)"},
    {"(1.249713)can0 123#", "(seconds.fraction)"},
    {"(0x1.249713) can0 123#", "(seconds.fraction)"},
    {"(1.24971) can0 123#", "6 or 9 decimals"},
    {"(1.2497130) can0 123#", "6 or 9 decimals"},
    {"(1.) can0 123#", "6 or 9 decimals"},
    {"(1.2497130000) can0 123#", "6 or 9 decimals"},
    {"(1000000000000.000000) can0 123#", "at most 12 digits"},
    {"(99999999999999999999999999.000000) can0 123#", "at most 12 digits"},
    {"(1.249713) ", "1 to 15 characters"},
    {"(1.249713) abcdefghijklmnop 123#", "1 to 15 characters"},
    {"(1.249713) can0", "id#data"},
    {"(1.249713) can0 ", "id#data"},
    {"(1.249713) can0 123", "id#data"},
    {"(1.249713) can0 123 #00", "id#data"},
    {kHead + "#00", "3 hex digits (standard) or 8 (extended)"},
    {kHead + "12#00", "3 hex digits (standard) or 8 (extended)"},
    {kHead + "1234#00", "3 hex digits (standard) or 8 (extended)"},
    {kHead + "123456789#00", "3 hex digits (standard) or 8 (extended)"},
    {kHead + "12G#00", "3 hex digits (standard) or 8 (extended)"},
    {kHead + "-12#00", "3 hex digits (standard) or 8 (extended)"},
    {kHead + "0x1#00", "3 hex digits (standard) or 8 (extended)"},
    {kHead + "800#00", "at most 7FF"},
    {kHead + "40000000#00", "at most 1FFFFFFF"},
    {kHead + "A0000000#00", "at most 1FFFFFFF"},
    {kHead + "123#1", "pairs of hex digits"},
    {kHead + "123#112", "pairs of hex digits"},
    {kHead + "123#1G", "pairs of hex digits"},
    {kHead + "123#G1", "pairs of hex digits"},
    {kHead + "123#11..22", "pairs of hex digits"},
    {kHead + "123#11.", "pairs of hex digits"},
    {kHead + "123#1.1", "pairs of hex digits"},
    {kHead + "123#112233445566778899", "at most 8 bytes"},
    {kHead + "123#R9", "length of 0 to 8"},
    {kHead + "123#RA", "length of 0 to 8"},
    {kHead + "123#R44", "length of 0 to 8"},
    {kHead + "123#R.", "length of 0 to 8"},
    {kHead + "123#1122334455667788_", "_9 to _F"},
    {kHead + "123#1122334455667788_8", "_9 to _F"},
    {kHead + "123#1122334455667788_99", "_9 to _F"},
    {kHead + "123#11223344556677_E", "_9 to _F"},
    {kHead + "123#R7_E", "_9 to _F"},
    {kHead + "123##", "one hex digit of flags"},
    {kHead + "123##G", "one hex digit of flags"},
    {kHead + "123##01", "pairs of hex digits"},
    {kHead + "123##0112233445566778899", "12, 16, 20, 24, 32, 48 or 64"},
    {kHead + "123##0" + std::string(130, 'A'), "12, 16, 20, 24, 32, 48 or 64"},
    {kHead + "20000004##0", "error frame must be classic data"},
    {kHead + "20000004#R", "error frame must be classic data"},
    {kHead + "45123#81:00:12345678#11223344.556677", "CAN XL"},
    {kHead + "123#80:00:12345678#1122", "CAN XL"},
    {kHead + "123#11 X", "only R or T"},
    {kHead + "123#11 RT", "only R or T"},
    {kHead + "123#11 R T", "only R or T"},
    {kHead + "123#11\n\n", "pairs of hex digits"},
    {kHead + "123 [2] 11", "as many bytes after the [length]"},
    {kHead + "123 [2] 11 2", "as many bytes after the [length]"},
    {kHead + "123 [9] 11 22 33 44 55 66 77 88 99", "as many bytes after the [length]"},
    {kHead + "123 [] 11", "followed by a frame"},
    {kHead + "123 (2) 11", "followed by a frame"},
    {kHead + "12 [1] 11", "3 hex digits"},
    {kHead + std::string("123#11 \0", 8), "only R or T"},
};

TEST_CASE("lines that only start like a frame say what would be right") {
  for (const BadLine& bad : kBadLines) {
    CAPTURE(bad.text);
    const CandumpLine line = parse_candump_line(bad.text);
    CHECK(line.status == CandumpStatus::malformed);
    CHECK_THAT(std::string(line.error), Catch::Contains(bad.right));
    CHECK(line.frame == CanFrame{});  // Never half a frame.
    CHECK(line.interface_name.empty());
  }
}

TEST_CASE("every truncation of a frame is a shorter frame or malformed, never another identifier") {
  const std::string text = kHead + "12345678##1000102030405060708090A0B";
  for (std::size_t size = 1; size < text.size(); ++size) {
    const CandumpLine line = parse_candump_line(text.substr(0, size));
    CAPTURE(text.substr(0, size));
    if (line.status == CandumpStatus::frame) {
      CHECK(line.frame.id == 0x12345678);
      CHECK(line.frame.length <= 8);
    } else {
      CHECK(line.status == CandumpStatus::malformed);
      CHECK_FALSE(line.error.empty());
    }
  }
}

TEST_CASE(
    "comments, empty lines, damaged drop reports and texts of errors are no frames and no errors") {
  const std::string text = GENERATE(
      "", "\n", "\r\n", "# comment", "DROPCOUNT", "DROPCOUNT: dropped",
      "DROPCOUNT: dropped x CAN frames on 'can0'", "DROPCOUNT: dropped 5 CAN frames on can0 socket",
      "DROPCOUNT: dropped 5 CAN frames on '' socket", "DROPCOUNT: dropped 5 on 'can0",
      "DROPCOUNT: dropped 99999999999999999999999 CAN frames on 'can0' socket",
      "\tcontroller-problem{rx-overflow}", "\tbus-error\r\n");
  const CandumpLine line = parse_candump_line(text);
  CAPTURE(text);
  CHECK(line.status == CandumpStatus::skipped);
  CHECK(line.dropped_frames == 0);
  CHECK(line.error.empty());
}

TEST_CASE("any other line is counted and told") {
  const BadLine bad = GENERATE(BadLine{"date Fri Jul 10", "must begin with (seconds"},
                               BadLine{"x", "must begin with"},
                               BadLine{"  can0  123   [2]  11 22", "`candump -ta`"},
                               BadLine{"  can0  123   [2]  11", "must begin with"});
  const CandumpLine line = parse_candump_line(bad.text);
  CAPTURE(bad.text);
  CHECK(line.status == CandumpStatus::malformed);
  CHECK_THAT(std::string(line.error), Catch::Contains(bad.right));
}

TEST_CASE("what candump prints on a terminal is read where it has stamps") {
  const GoodLine good = GENERATE(
      GoodLine{"123   [4]  11 22 33 44",
               make_frame(Kind::standard, 0x123, {0x11, 0x22, 0x33, 0x44})},
      GoodLine{"123   [0]", make_frame(Kind::standard, 0x123)},
      GoodLine{"123   [2]  11 22   '.\"'", make_frame(Kind::standard, 0x123, {0x11, 0x22})},
      GoodLine{"RX - -  123   [1]  AB", make_frame(Kind::standard, 0x123, {0xAB})},
      GoodLine{"TX B E  12345678   [1]  AB", make_frame(Kind::extended, 0x12345678, {0xAB})},
      GoodLine{"123   [0]  remote request", make_frame(Kind::remote, 0x123)},
      GoodLine{"123   [4]  remote request", with_length(make_frame(Kind::remote, 0x123), 4)},
      GoodLine{"     7FF   [1]  0A", make_frame(Kind::standard, 0x7FF, {0x0A})},
      GoodLine{"20000004   [2]  00 20   ERRORFRAME", make_frame(Kind::error, 4, {0, 0x20})},
      GoodLine{"123  [02]  11 22", make_frame(Kind::fd, 0x123, {0x11, 0x22})});
  const std::string text = " (1436509052.249713)  can0  " + good.text + "\n";
  const CandumpLine line = parse_candump_line(text);
  CAPTURE(text, line.error);
  REQUIRE(line.status == CandumpStatus::frame);
  CHECK(line.frame == good.frame);
  CHECK(line.interface_name == "can0");
}

TEST_CASE("on a terminal too there are no remote requests of FD and no errors but classic data") {
  const BadLine bad = GENERATE(BadLine{"2CC  [16]  remote request", "as many bytes"},
                               BadLine{"2CC  [9]  remote request", "length of 0 to 8"},
                               BadLine{"20000004  [2]  remote request", "must be classic data"},
                               BadLine{"20000004  [02]  00 20", "must be classic data"});
  const CandumpLine line =
      parse_candump_line(std::string("(1436509052.249713)  can0  ") + bad.text);
  CAPTURE(bad.text);
  CHECK(line.status == CandumpStatus::malformed);
  CHECK_THAT(std::string(line.error), Catch::Contains(bad.right));
}

TEST_CASE("drop reports give the number lost and the interface") {
  struct Row {
    const char* text;
    std::uint64_t dropped;
    const char* interface_name;
  };
  const std::vector<Row> rows = {
      {"DROPCOUNT: dropped 4722 CAN frames on 'can0' socket (total drops 4722)", 4722, "can0"},
      {"DROPCOUNT: dropped 1 CAN frame on 'vcan12' socket (total drops 9)\r\n", 1, "vcan12"},
      {"DROPCOUNT: dropped 4294967295 CAN frames on 'any' socket (total drops 3)\n", 4294967295,
       "any"},
  };
  for (const Row& row : rows) {
    const CandumpLine line = parse_candump_line(row.text);
    CHECK(line.status == CandumpStatus::dropped);
    CHECK(line.dropped_frames == row.dropped);
    CHECK(line.interface_name == row.interface_name);
  }
}

}  // namespace
}  // namespace cremed
