// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/source/log_format.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <spdlog/fmt/fmt.h>

#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

using namespace std::string_view_literals;

/// With {} for the file.
using Remedy = const char*;
constexpr Remedy kConvert = "`python3 -m can.logconvert {} drive.log` (python3-can)";
constexpr Remedy kRecord =
    "frames are read from candump logs: record the bus with `candump -l any`";
constexpr Remedy kEvaluate =
    "give it to `cremed-eval drive`, and to --replay the frames it was made of";

struct Format {
  std::string_view magic;
  std::string_view name;
  Remedy remedy;
};

constexpr std::array kFormats = {
    Format{"\x1F\x8B"sv, "compressed by gzip", "`zcat {} >drive.log`"},
    Format{"\xFD"
           "7zXZ\0"sv,
           "compressed by xz", "`xzcat {} >drive.log`"},
    Format{"\x28\xB5\x2F\xFD"sv, "compressed by zstd", "`zstdcat {} >drive.log`"},
    Format{"BZh"sv, "compressed by bzip2", "`bzcat {} >drive.log`"},
    Format{"\x04\x22\x4D\x18"sv, "compressed by lz4", "`lz4cat {} >drive.log`"},
    Format{"PK\x03\x04"sv, "a zip archive", "`unzip -p {} >drive.log`"},
    Format{"LOGG"sv, "a BLF log", kConvert},
    Format{";$FILEVERSION"sv, "a PCAN trace", kConvert},
    Format{";####"sv, "a PCAN trace 1.0", kConvert},
    Format{"date "sv, "an ASC log", "`asc2log -I {} -O drive.log` (can-utils)"},
    Format{"\xED\xA1\xDA\x01"sv, "an LCM log",
           "it has messages, not CAN frames: `cremed-lcm-to-csv {}`"},
    Format{"\xFF\xFE"sv, "UTF-16 text", "`iconv -f UTF-16 -t UTF-8 {} >drive.log`"},
    Format{"\xD4\xC3\xB2\xA1"sv, "a pcap capture", kRecord},
    Format{"\xA1\xB2\xC3\xD4"sv, "a pcap capture", kRecord},
    Format{"\x4D\x3C\xB2\xA1"sv, "a pcap capture", kRecord},
    Format{"\xA1\xB2\x3C\x4D"sv, "a pcap capture", kRecord},
    Format{"\x0A\x0D\x0D\x0A"sv, "a pcapng capture", kRecord},
    Format{"MDF     "sv, "an MDF (MF4) log", kRecord},
    Format{"#ROSBAG"sv, "a rosbag", kRecord},
    Format{"SQLite format 3"sv, "an SQLite database (db3)", kRecord},
    Format{"\x89MCAP0"sv, "an MCAP file", kRecord},
    Format{"utime_start,utime,source,"sv, "cremed's own odometry", kEvaluate},
    Format{"utime,utime_anchor,"sv, "cremed's own odometry", kEvaluate},
};

/// What python-can writes, and reads.
constexpr std::string_view kCsvColumns = "timestamp,arbitration_id,extended,remote,error,dlc,data";
constexpr std::string_view kCsvFrame = "timestamp,arbitration_id,";
constexpr long kMinCommas = 3;

/// In every line of `candump -c` and `-ca`; with the sequences that begin so the rest is a log.
constexpr std::string_view kColour = "\x1B[";
constexpr Remedy kUncolour = "`sed 's/\\x1B\\[[0-9;]*m//g' {} >drive.log`";

std::string remedy_text(Remedy remedy, const std::string& path) {
  return fmt::format(fmt::runtime(remedy), path == "-" ? "LOG" : in_shell(path));
}

bool is_csv(std::string_view line) {
  return std::ranges::count(line, ',') >= kMinCommas &&
         line.find_first_of("(#") == std::string_view::npos;
}

std::string csv_text(std::string_view header, const std::string& path) {
  return header.starts_with(kCsvFrame)
             ? concat({"CSV; ", remedy_text(kConvert, path)})
             : concat({"CSV without the columns of frames, which are ", in_quotes(kCsvColumns),
                       " as python3-can writes them; ", kRecord});
}

}  // namespace

std::string foreign_format(std::string_view begin, const std::string& path) {
  const std::string what = concat({path == "-" ? "standard input" : printable(path), " is "});
  const auto* const found = std::ranges::find_if(
      kFormats, [&](const Format& format) { return begin.starts_with(format.magic); });
  if (found != kFormats.end()) {
    return concat({what, found->name, "; ", remedy_text(found->remedy, path)});
  }
  const std::string_view line = begin.substr(0, begin.find('\n'));
  if (line.find(kColour) != std::string_view::npos) {
    return concat({what, "text in the colours of `candump -c`; ", remedy_text(kUncolour, path)});
  }
  return is_csv(line) ? concat({what, csv_text(line, path)}) : std::string();
}

void refuse_foreign_format(std::string_view begin, const std::string& path) {
  if (const std::string problem = foreign_format(begin, path); !problem.empty()) {
    throw std::runtime_error(problem);
  }
}

}  // namespace cremed
