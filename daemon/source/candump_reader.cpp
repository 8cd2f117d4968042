// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/source/candump_reader.hpp"

#include <cerrno>
#include <cstring>

#include "daemon/process/message_text.hpp"
#include "daemon/source/log_format.hpp"

namespace cremed {
namespace {

/// Without its line feed. A shorter frame may be the beginning of one of 8 bytes.
bool can_be_whole(const CandumpLine& line) {
  constexpr std::size_t kMostBytes = 8;
  return line.status == CandumpStatus::frame ? line.frame.length >= kMostBytes
                                             : line.status != CandumpStatus::malformed;
}

}  // namespace

CandumpReader::CandumpReader(const std::string& path) : path_(path), lines_(path) {
  refuse_foreign_format(lines_.begin(), path_);
}

bool CandumpReader::next(CandumpLine& line) {
  std::string_view text;
  line = {};
  switch (lines_.next(text)) {
    case LineReader::Status::line:
      if (lines_.line_number() == 1) {
        refuse_foreign_format(text, path_);
      }
      line = parse_candump_line(text);
      break;
    case LineReader::Status::too_long:
      line.status = CandumpStatus::malformed;
      line.error = "longer than 65536 characters, no line of a candump log is";
      break;
    case LineReader::Status::interrupted:
      break;
    case LineReader::Status::failed:
      read_error_ = errno;
      return false;
    case LineReader::Status::end:
      return false;
  }
  if (lines_.is_unfinished() && !can_be_whole(line)) {
    is_cut_off_ = true;
    line = {};
  }
  if (line.status == CandumpStatus::frame) {
    stamps_.add(line.interface_name, line.frame.stamp_us);
  } else if (line.status == CandumpStatus::malformed && malformed_lines_++ == 0) {
    first_malformed_ = lines_.line_number();
    reason_ = line.error;
  }
  return true;
}

std::string CandumpReader::malformed() const {
  return malformed_lines_ == 0
             ? ""
             : concat({path_, ":", std::to_string(first_malformed_), ": ", reason_, " (",
                       counted(malformed_lines_, "such line"), ")"});
}

std::string CandumpReader::cut_off() const {
  return is_cut_off_ ? concat({path_, ":", std::to_string(lines_.line_number()),
                               ": the log ends within this line, which is left out"})
                     : "";
}

std::string CandumpReader::problem() const {
  return read_error_ != 0 ? concat({path_, ": ", std::strerror(read_error_)})
                          : stamps_.problem(path_);
}

std::string CandumpReader::no_frame() const {
  return malformed_lines_ == 0
             ? concat({path_, ": no CAN frame in it; lines of `candump -L` are expected"})
             : concat({path_, ": no CAN frame in it; ", malformed()});
}

}  // namespace cremed
