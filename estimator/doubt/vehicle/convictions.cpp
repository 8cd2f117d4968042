// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/convictions.hpp"

#include <algorithm>
#include <bit>

namespace cremed {
namespace {

/// First and longest time for which a radar stays at fault without new evidence.
constexpr std::int64_t kFirstHoldUs = 5'000'000;
constexpr std::int64_t kLongestHoldUs = 640'000'000;
/// The hold is halved for each such time without evidence, so that a fault of an hour ago hardly
/// counts.
constexpr std::int64_t kHalfLifeUs = kLongestHoldUs;
constexpr std::int64_t kMostHalvings = 30;  // Nothing is left of any hold.
/// First hold after a radar's own check while most radars that are heard are at fault.
constexpr std::int64_t kFirstSharedHoldUs = 500'000;

}  // namespace

void Convictions::leave_clock() {
  for (Verdict& verdict : verdicts_) {
    verdict.until_us.reset();
  }
}

void Convictions::convict(std::size_t radar, std::int64_t time_us) {
  Verdict& verdict = verdicts_[radar];
  if (!contains(at_fault_, radar)) {
    const std::int64_t healthy_us = time_us - verdict.until_us.value_or(time_us);
    const auto halvings = std::clamp<std::int64_t>(healthy_us / kHalfLifeUs, 0, kMostHalvings);
    verdict.hold_us >>= halvings;
    verdict.shared_hold_us >>= halvings;
    verdict.hold_us = std::clamp(2 * verdict.hold_us, kFirstHoldUs, kLongestHoldUs);
    verdict.shared_hold_us =
        std::clamp(2 * verdict.shared_hold_us, kFirstSharedHoldUs, kLongestHoldUs);
    is_new_ = true;
  }
  at_fault_ |= set_of(radar);
  verdict.until_us = time_us + verdict.hold_us;
}

void Convictions::accuse(std::size_t radar, RadarSet heard, std::int64_t time_us) {
  convict(radar, time_us);
  accused_ |= set_of(radar);
  if (2 * std::popcount(at_fault_ & heard) > std::popcount(heard)) {
    verdicts_[radar].until_us = time_us + verdicts_[radar].shared_hold_us;
  }
}

void Convictions::acquit(RadarSet set) {
  at_fault_ &= ~set;
  accused_ &= ~set;
}

void Convictions::release(std::int64_t time_us) {
  for (std::size_t radar = 0; radar < verdicts_.size(); ++radar) {
    Verdict& verdict = verdicts_[radar];
    verdict.until_us = verdict.until_us.value_or(time_us + verdict.hold_us);
    if (time_us > *verdict.until_us) {
      acquit(set_of(radar));
    }
  }
}

}  // namespace cremed
