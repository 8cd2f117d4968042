// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <string_view>

#include <catch2/catch.hpp>

#include "daemon/source/log_format.hpp"

namespace cremed {
namespace {

using namespace std::string_view_literals;

TEST_CASE("What is no candump log is answered with the command that makes one of it") {
  struct Row {
    std::string_view begin;
    const char* answer;
  };
  const Row row = GENERATE(
      Row{"\x1F\x8B\x08\0\0"sv, "a b.x is compressed by gzip; `zcat 'a b.x' >drive.log`"},
      Row{"\xFD"
          "7zXZ\0\0"sv,
          "`xzcat "},
      Row{"\x28\xB5\x2F\xFD\x04"sv, "`zstdcat "}, Row{"BZh91AY"sv, "`bzcat "},
      Row{"\x04\x22\x4D\x18\x64"sv, "`lz4cat "}, Row{"PK\x03\x04\x14"sv, "`unzip -p "},
      Row{"LOGG\x90\0\0\0"sv, "a BLF log; `python3 -m can.logconvert "},
      Row{";$FILEVERSION=1.1\r\n"sv, "`python3 -m can.logconvert "},
      Row{";##########\r\n;   C:\\a.trc\r\n"sv, "a PCAN trace 1.0; `python3 -m can.logconvert "},
      Row{" (1436509052.249713)  \x1B[31mcan0  123   [1]  11\x1B[0m\n"sv,
          "text in the colours of `candump -c`; `sed 's/\\x1B\\[[0-9;]*m//g' 'a b.x' >drive.log`"},
      Row{"date Fri Jul 10 2026\nbase hex  timestamps absolute\n"sv, "`asc2log -I "},
      Row{"\xED\xA1\xDA\x01\0\0"sv, "`cremed-lcm-to-csv "},
      Row{"\xFF\xFE(\0"sv, "UTF-16 text; `iconv -f UTF-16 -t UTF-8 "},
      Row{"\xD4\xC3\xB2\xA1\x02\0"sv, "a pcap capture; frames are read from candump logs"},
      Row{"\x0A\x0D\x0D\x0A\x1C"sv, "a pcapng capture; "},
      Row{"MDF     4.10    "sv, "an MDF (MF4) log; "}, Row{"#ROSBAG V2.0\n"sv, "a rosbag; "},
      Row{"SQLite format 3\0"sv, "an SQLite database (db3); "},
      Row{"\x89MCAP0\r\n"sv, "an MCAP file; "},
      Row{"utime_start,utime,source,x_m\n"sv, "`cremed-eval drive`"},
      Row{"timestamp,arbitration_id,extended,remote\n1,"sv, "is CSV; `python3 -m can.logconvert "},
      Row{"time,x,y,z\n1,"sv,
          "is CSV without the columns of frames, which are "
          "\"timestamp,arbitration_id,extended,remote,error,dlc,data\" as python3-can writes them; "
          "frames are read from candump logs"});
  const std::string answer = foreign_format(row.begin, "a b.x");
  CAPTURE(answer);
  CHECK(answer.find(row.answer) != std::string::npos);
}

TEST_CASE("Logs, comments, nothing and noise are not taken for another format") {
  const auto* begin = GENERATE("(1436509052.249713) can0 123#11", "# a, b, c, d", "", "\x01\x02",
                               "  can0  123   [2]  11 22", "DROPCOUNT: dropped 1");
  CHECK(foreign_format(std::string_view(begin), "-").empty());
}

TEST_CASE("The command takes a path as it is, however long and whatever a shell does with it") {
  const auto command = [](const std::string& path) {
    const std::string answer = foreign_format("BZh91AY", path);
    const std::size_t begin = answer.find("`bzcat ");
    REQUIRE(begin != std::string::npos);
    return answer.substr(begin);
  };
  CHECK(command("logs/a-1_2.bz2") == "`bzcat logs/a-1_2.bz2 >drive.log`");
  CHECK(command("$HOME `id`") == "`bzcat '$HOME `id`' >drive.log`");
  CHECK(command("~it's") == "`bzcat '~it'\\''s' >drive.log`");
  const std::string longest(200, 'x');
  CHECK(command(longest) == "`bzcat " + longest + " >drive.log`");
}

}  // namespace
}  // namespace cremed
