// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/source/candump_log.hpp"

#include <algorithm>
#include <utility>

namespace cremed {
namespace {

/// Limit for messages: a corrupt log may name many.
constexpr std::size_t kMaxOtherInterfaces = 8;

}  // namespace

CandumpLog::CandumpLog(const std::string& path, std::vector<std::string> interfaces,
                       const volatile std::sig_atomic_t* stop)
    : reader_(path),
      interfaces_(std::move(interfaces)),
      has_frames_(interfaces_.size()),
      stop_(stop) {}

SourceEvent CandumpLog::next(CanFrame& frame) {
  CandumpLine line;
  while (*stop_ == 0) {
    if (untold_losses_ != 0) {
      frame.interface = static_cast<std::uint8_t>(interfaces_.size() - untold_losses_--);
      return SourceEvent::dropped;
    }
    if (!reader_.next(line)) {
      break;
    }
    const std::size_t interface = index_of(line.interface_name);
    const bool is_ours = interface != interfaces_.size();
    if (line.status == CandumpStatus::dropped) {
      counters_.lost_frames += line.dropped_frames;
      if (is_ours) {
        frame.interface = static_cast<std::uint8_t>(interface);
        return SourceEvent::dropped;
      }
      untold_losses_ = line.interface_name == kAllInterfaces ? interfaces_.size() : 0;
    } else if (line.status == CandumpStatus::frame && is_ours) {
      ++counters_.frames;
      has_frames_[interface] = true;
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

std::size_t CandumpLog::index_of(std::string_view interface_name) const {
  return static_cast<std::size_t>(std::ranges::find(interfaces_, interface_name) -
                                  interfaces_.begin());
}

}  // namespace cremed
