// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/source/log_format.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

using namespace std::string_view_literals;

enum class Way : std::uint8_t {
  unpack,   // A command writes the log to standard output.
  convert,  // python-can writes a file.
  asc,
  odometry,
  results,
  record,  // Nothing at hand converts it.
};

struct Format {
  std::string_view magic;
  std::string_view name;
  Way way;
  std::string_view command;
};

constexpr std::array kFormats = {
    Format{"\x1F\x8B"sv, "compressed by gzip", Way::unpack, "zcat"},
    Format{"\xFD"
           "7zXZ\0"sv,
           "compressed by xz", Way::unpack, "xzcat"},
    Format{"\x28\xB5\x2F\xFD"sv, "compressed by zstd", Way::unpack, "zstdcat"},
    Format{"BZh"sv, "compressed by bzip2", Way::unpack, "bzcat"},
    Format{"\x04\x22\x4D\x18"sv, "compressed by lz4", Way::unpack, "lz4cat"},
    Format{"PK\x03\x04"sv, "a zip archive", Way::unpack, "unzip -p"},
    Format{"LOGG"sv, "a BLF log", Way::convert, ""},
    Format{";$FILEVERSION"sv, "a PCAN trace", Way::convert, ""},
    Format{";####"sv, "a PCAN trace 1.0", Way::convert, ""},
    Format{"date "sv, "an ASC log", Way::asc, ""},
    Format{"\xED\xA1\xDA\x01"sv, "an LCM log", Way::results, ""},
    Format{"\xFF\xFE"sv, "UTF-16 text", Way::unpack, "iconv -f UTF-16 -t UTF-8"},
    Format{"\xD4\xC3\xB2\xA1"sv, "a pcap capture", Way::record, ""},
    Format{"\xA1\xB2\xC3\xD4"sv, "a pcap capture", Way::record, ""},
    Format{"\x4D\x3C\xB2\xA1"sv, "a pcap capture", Way::record, ""},
    Format{"\xA1\xB2\x3C\x4D"sv, "a pcap capture", Way::record, ""},
    Format{"\x0A\x0D\x0D\x0A"sv, "a pcapng capture", Way::record, ""},
    Format{"MDF     "sv, "an MDF (MF4) log", Way::record, ""},
    Format{"#ROSBAG"sv, "a rosbag", Way::record, ""},
    Format{"SQLite format 3"sv, "an SQLite database (db3)", Way::record, ""},
    Format{"\x89MCAP0"sv, "an MCAP file", Way::record, ""},
    Format{"utime_start,utime,source,"sv, "cremed's own odometry", Way::odometry, ""},
    Format{"utime,utime_anchor,"sv, "cremed's own odometry", Way::odometry, ""},
};

/// What python-can writes, and reads.
constexpr std::string_view kCsvColumns = "timestamp,arbitration_id,extended,remote,error,dlc,data";
constexpr std::string_view kCsvFrame = "timestamp,arbitration_id,";
constexpr long kMinCommas = 3;

/// In every line of `candump -c` and `-ca`; with the sequences that begin so the rest is a log.
constexpr std::string_view kColour = "\x1B[";
constexpr std::string_view kWithoutColours = "sed 's/\\x1B\\[[0-9;]*m//g'";

std::string remedy(Way way, std::string_view command, const std::string& path) {
  const std::string file = path == "-" ? "LOG" : in_shell(path);
  switch (way) {
    case Way::unpack:
      return concat({"`", command, " ", file, " >drive.log`"});
    case Way::convert:
      return concat({"`python3 -m can.logconvert ", file, " drive.log` (python3-can)"});
    case Way::asc:
      return concat({"`asc2log -I ", file, " -O drive.log` (can-utils)"});
    case Way::results:
      return concat({"it has messages, not CAN frames: `cremed-lcm-to-csv ", file, "`"});
    case Way::record:
      return "frames are read from candump logs: record the bus with `candump -l any`";
    case Way::odometry:
      return concat({"give it to `cremed-eval drive`, and to --replay the frames it was made of"});
  }
  return {};
}

bool is_csv(std::string_view line) {
  return std::ranges::count(line, ',') >= kMinCommas &&
         line.find_first_of("(#") == std::string_view::npos;
}

std::string csv_text(std::string_view header, const std::string& path) {
  return header.starts_with(kCsvFrame)
             ? concat({"CSV; ", remedy(Way::convert, "", path)})
             : concat({"CSV without the columns of frames, which are ", in_quotes(kCsvColumns),
                       " as python3-can writes them; ", remedy(Way::record, "", path)});
}

}  // namespace

std::string foreign_format(std::string_view begin, const std::string& path) {
  const std::string what = concat({path == "-" ? "standard input" : printable(path), " is "});
  const auto* const found = std::ranges::find_if(
      kFormats, [&](const Format& format) { return begin.starts_with(format.magic); });
  if (found != kFormats.end()) {
    return concat({what, found->name, "; ", remedy(found->way, found->command, path)});
  }
  const std::string_view line = begin.substr(0, begin.find('\n'));
  if (line.find(kColour) != std::string_view::npos) {
    return concat({what, "text in the colours of `candump -c`; ",
                   remedy(Way::unpack, kWithoutColours, path)});
  }
  return is_csv(line) ? concat({what, csv_text(line, path)}) : std::string();
}

void refuse_foreign_format(std::string_view begin, const std::string& path) {
  if (const std::string problem = foreign_format(begin, path); !problem.empty()) {
    throw std::runtime_error(problem);
  }
}

}  // namespace cremed
