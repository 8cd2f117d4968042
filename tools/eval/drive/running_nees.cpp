// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/running_nees.hpp"

#include <algorithm>
#include <map>
#include <numeric>

namespace cremed {

std::vector<RunningNees> running_nees(const std::vector<TimedNees>& estimates,
                                      int degrees_of_freedom, std::int64_t window_us) {
  std::vector<RunningNees> result;
  std::map<std::size_t, Interval> intervals;  // By count: of a few sizes, and slow to compute.
  auto begin = estimates.begin();
  auto end = begin;
  for (const TimedNees& centre : estimates) {
    begin = std::find_if(begin, estimates.end(), [&](const TimedNees& e) {
      return e.utime_us >= centre.utime_us - window_us / 2;
    });
    end = std::find_if(end, estimates.end(), [&](const TimedNees& e) {
      return e.utime_us > centre.utime_us + window_us / 2;
    });
    const auto count = static_cast<std::size_t>(end - begin);
    const double sum = std::accumulate(
        begin, end, 0.0, [](double total, const TimedNees& e) { return total + e.nees; });
    const auto [interval, is_new] = intervals.try_emplace(count);
    if (is_new) {
      interval->second = anees_interval(count, degrees_of_freedom, 0.95);
    }
    result.push_back({sum / static_cast<double>(count), interval->second});
  }
  return result;
}

}  // namespace cremed
