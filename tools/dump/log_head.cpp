// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/dump/log_head.hpp"

#include <stdexcept>

#include "tools/doctor/log_observation.hpp"
#include "tools/doctor/unconfigured.hpp"

namespace cremed {
namespace {

/// The longest period of a radar's messages is a second.
constexpr std::int64_t kHeadUs = 2'000'000;
/// More than five full buses carry in that time, 111 us a frame at 1 Mbit/s.
constexpr std::size_t kMostLines = 100'000;

}  // namespace

LogHead::LogHead() : observer_(without_radars()) {}

void LogHead::add(const CandumpLine& line) {
  lines_.push_back({line, std::string(line.interface_name)});
  if (line.status == CandumpStatus::frame) {
    observer_.add(line.interface_name, line.frame);
    first_us_ = first_us_.value_or(line.frame.stamp_us);
    is_complete_ = line.frame.stamp_us >= *first_us_ + kHeadUs;
  }
  is_complete_ = is_complete_ || lines_.size() >= kMostLines;
}

Configuration LogHead::examined(const std::string& path) {
  if (!first_us_) {
    throw std::runtime_error(no_frame_in(path));
  }
  return examined_radars(observer_.finish());
}

void LogHead::replay(const std::function<void(const CandumpLine&)>& take) const {
  for (const Kept& kept : lines_) {
    CandumpLine line = kept.line;
    line.interface_name = kept.interface;
    take(line);
  }
}

}  // namespace cremed
