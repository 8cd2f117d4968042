// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/radar/nis_mean.hpp"

#include <algorithm>

namespace cremed {
namespace {

constexpr std::int64_t kUsPerSecond = 1'000'000;

}  // namespace

void NisMean::clear() {
  seconds_.fill({});
  count_ = 0;
}

void NisMean::add(std::int64_t utime_us, double nis) {
  pass(utime_us);
  Second& now = seconds_[static_cast<std::uint64_t>(second_) % kSeconds];
  ++now.count;
  now.sum += std::min(nis, kMaxNis);
  ++count_;
}

void NisMean::pass(std::int64_t utime_us) {
  const std::int64_t second = utime_us / kUsPerSecond;
  if (second < second_ || second - second_ >= static_cast<std::int64_t>(kSeconds)) {
    clear();
    second_ = second;
  }
  while (second_ < second) {
    ++second_;
    Second& oldest = seconds_[static_cast<std::uint64_t>(second_) % kSeconds];
    count_ -= oldest.count;
    oldest = {};
  }
}

double NisMean::mean() const {
  double sum = 0.0;
  for (const Second& second : seconds_) {
    sum += second.sum;
  }
  return count_ == 0 ? 0.0 : sum / static_cast<double>(count_);
}

}  // namespace cremed
