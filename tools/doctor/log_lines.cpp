// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/log_lines.hpp"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "daemon/process/message_text.hpp"
#include "daemon/source/line_reader.hpp"
#include "daemon/source/log_format.hpp"

namespace cremed {

void read_log(const std::string& path, const std::function<void(const CandumpLine&)>& take) {
  LineReader reader(path);
  refuse_foreign_format(reader.begin(), path);
  std::string_view text;
  for (auto status = reader.next(text); status != LineReader::Status::end;
       status = reader.next(text)) {
    if (status == LineReader::Status::failed) {
      throw std::runtime_error(concat({path, ": ", std::strerror(errno)}));
    }
    if (status == LineReader::Status::line) {
      if (reader.line_number() == 1) {
        refuse_foreign_format(text, path);
      }
      take(parse_candump_line(text));
    }
  }
}

}  // namespace cremed
