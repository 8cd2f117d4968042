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
    Format{"PK\x03\x04"sv, "a zip archive", Way::unpack, "unzip -p"},
    Format{"LOGG"sv, "a BLF log", Way::convert, ""},
    Format{";$FILEVERSION"sv, "a PCAN trace", Way::convert, ""},
    Format{"date "sv, "an ASC log", Way::asc, ""},
    Format{"\xED\xA1\xDA\x01"sv, "an LCM log", Way::results, ""},
    Format{"utime_start,utime,source,"sv, "cremed's own odometry", Way::odometry, ""},
    Format{"utime,utime_anchor,"sv, "cremed's own odometry", Way::odometry, ""},
};

/// python-can's CSV begins with "timestamp,arbitration_id,extended,remote,error,dlc,data".
constexpr std::string_view kCsv = "CSV";
constexpr long kMinCommas = 3;

std::string in_shell(std::string_view path) {
  return path.find_first_of(" '\"$`\\()&;<>|*?") == std::string_view::npos
             ? std::string(path)
             : concat({"\"", path, "\""});
}

std::string remedy(Way way, std::string_view command, const std::string& path) {
  const std::string file = path == "-" ? "LOG" : in_shell(printable(path));
  switch (way) {
    case Way::unpack:
      return concat({"`", command, " ", file, " >drive.log`"});
    case Way::convert:
      return concat({"`python3 -m can.logconvert ", file, " drive.log` (python3-can)"});
    case Way::asc:
      return concat({"`asc2log -I ", file, " -O drive.log` (can-utils)"});
    case Way::results:
      return concat({"it has messages, not CAN frames: `cremed-lcm-to-csv ", file, "`"});
    case Way::odometry:
      return concat({"give it to `cremed-eval drive`, and to --replay the frames it was made of"});
  }
  return {};
}

bool is_csv(std::string_view line) {
  return std::count(line.begin(), line.end(), ',') >= kMinCommas &&
         line.find_first_of("(#") == std::string_view::npos;
}

}  // namespace

std::string foreign_format(std::string_view begin, const std::string& path) {
  const std::string what = concat({path == "-" ? "standard input" : printable(path), " is "});
  const auto* const found =
      std::find_if(kFormats.begin(), kFormats.end(),
                   [&](const Format& format) { return begin.starts_with(format.magic); });
  if (found != kFormats.end()) {
    return concat({what, found->name, "; ", remedy(found->way, found->command, path)});
  }
  const bool is_table = is_csv(begin.substr(0, begin.find('\n')));
  return is_table ? concat({what, kCsv, "; ", remedy(Way::convert, "", path)}) : std::string();
}

void refuse_foreign_format(std::string_view begin, const std::string& path) {
  if (const std::string problem = foreign_format(begin, path); !problem.empty()) {
    throw std::runtime_error(problem);
  }
}

}  // namespace cremed
