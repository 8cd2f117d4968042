// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/source/candump_log.hpp"

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <utility>

#include "daemon/source/log_format.hpp"

namespace cremed {
namespace {

/// Limit for messages: a corrupt log may name many.
constexpr std::size_t kMaxOtherInterfaces = 8;

}  // namespace

CandumpLog::CandumpLog(const std::string& path, std::vector<std::string> interfaces,
                       const volatile std::sig_atomic_t* stop)
    : path_(path),
      reader_(path),
      interfaces_(std::move(interfaces)),
      has_frames_(interfaces_.size()),
      stop_(stop) {
  refuse_foreign_format(reader_.begin(), path_);
}

SourceEvent CandumpLog::next(CanFrame& frame) {
  while (*stop_ == 0) {
    std::string_view text;
    switch (reader_.next(text)) {
      case LineReader::Status::line:
        break;
      case LineReader::Status::too_long:
        complain("longer than 65536 characters, no line of a candump log is");
        continue;
      case LineReader::Status::interrupted:
        continue;
      case LineReader::Status::failed:
        read_error_ = errno;
        return SourceEvent::end;
      case LineReader::Status::end:
        return SourceEvent::end;
    }
    if (reader_.line_number() == 1) {
      refuse_foreign_format(text, path_);
    }
    const CandumpLine line = parse_candump_line(text);
    const std::size_t interface = index_of(line.interface_name);
    const bool is_ours = interface != interfaces_.size();
    if (line.status == CandumpStatus::malformed) {
      complain(line.error);
    } else if (line.status == CandumpStatus::dropped) {
      counters_.lost_frames += line.dropped_frames;
      if (is_ours) {
        frame.interface = static_cast<std::uint8_t>(interface);
        return SourceEvent::dropped;
      }
    } else if (line.status == CandumpStatus::frame && is_ours) {
      ++counters_.frames;
      has_frames_[interface] = true;
      stamps_.add(line.interface_name, line.frame.stamp_us);
      frame = line.frame;
      frame.interface = static_cast<std::uint8_t>(interface);
      return SourceEvent::frame;
    } else if (line.status == CandumpStatus::frame) {
      count_other(line.interface_name);
    }
  }
  return SourceEvent::end;
}

void CandumpLog::count_other(std::string_view interface) {
  ++counters_.other_interface_frames;
  const bool is_known = std::ranges::find(other_interfaces_, interface) != other_interfaces_.end();
  if (!is_known && other_interfaces_.size() < kMaxOtherInterfaces) {
    other_interfaces_.emplace_back(interface);
  }
}

void CandumpLog::complain(std::string_view reason) {
  if (counters_.malformed_lines++ == 0) {
    complaint_ = {reader_.line_number(), reason};
  }
}

std::size_t CandumpLog::index_of(std::string_view interface_name) const {
  return static_cast<std::size_t>(std::ranges::find(interfaces_, interface_name) -
                                  interfaces_.begin());
}

}  // namespace cremed
