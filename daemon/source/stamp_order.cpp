// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/source/stamp_order.hpp"

#include <algorithm>

#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

/// Of the steps that are not 0; a clock that is set makes a few. Most times between the frames of a
/// list are equal.
constexpr std::uint64_t kMostStepsBackPercent = 3;
constexpr std::uint64_t kFewSteps = 10;
/// Longer than any drive: stamps beyond are times since 1970.
constexpr std::int64_t kLongestDriveUs = 1'000'000'000'000;

}  // namespace

void StampOrder::add(std::string_view interface, std::int64_t stamp_us) {
  auto known = std::ranges::find(interfaces_, interface, &Interface::name);
  if (known == interfaces_.end()) {
    if (interfaces_.size() == kMostInterfaces) {
      return;
    }
    known = interfaces_.insert(known, {std::string(interface), stamp_us});
    is_joined_ = is_joined_ || stamp_us < latest_us_ - kLongestDisorderUs;
  } else {
    is_joined_ = is_joined_ && known + 1 == interfaces_.end();
    ++steps_;
    steps_still_ += stamp_us == known->last_us ? 1 : 0;
    steps_back_ += stamp_us < known->last_us ? 1 : 0;
  }
  known->last_us = stamp_us;
  latest_us_ = std::max(latest_us_, stamp_us);
}

std::string StampOrder::problem(const std::string& path) const {
  if (steps_ > kFewSteps && steps_still_ == steps_) {
    return concat({printable(path), ": the stamps stand still: in ", counted(steps_, "step"),
                   " none differs from the one before; without times there is no odometry, record "
                   "with `candump -l`"});
  }
  if (is_joined_) {
    return concat({printable(path),
                   ": one interface follows another, with stamps of the time before: logs of "
                   "interfaces were joined; `sort -s -k1,1 LOG` corrects that"});
  }
  if (steps_back_ <= kFewSteps ||
      100 * steps_back_ <= kMostStepsBackPercent * (steps_ - steps_still_)) {
    return {};
  }
  const std::string what = concat({printable(path), ": the stamps run backwards ",
                                   counted(steps_back_, "time"), " in ", counted(steps_, "step")});
  return latest_us_ < kLongestDriveUs
             ? concat({what,
                       ": they are times between frames, as of `candump -td`, or lines are "
                       "shuffled; record with `candump -l`"})
             : concat({what, ": lines are out of order; `sort -s -k1,1 LOG` corrects that"});
}

}  // namespace cremed
