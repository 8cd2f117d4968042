// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/missing_time.hpp"

#include <cstdio>

#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

/// Shorter ones are a scan or two.
constexpr std::int64_t kLongSpanUs = 500'000;
constexpr std::size_t kMostSpans = 3;

/// Above it interpolation errs as much as the odometry does, or more.
constexpr std::int64_t kLongStepUs = 250'000;

void say_sparse(const std::string& path, const std::vector<std::int64_t>& utime_us) {
  const std::int64_t step_us = usual_step_us(utime_us);
  if (step_us > kLongStepUs) {
    std::fprintf(stderr,
                 "%s: a row every %s s only: interpolation between them adds to the errors\n",
                 path.c_str(), tenths(static_cast<double>(step_us) * 1e-6).c_str());
  }
}

}  // namespace

std::string told_spans(const std::vector<TimeSpan>& without, std::int64_t begin_us) {
  const auto seconds = [&](std::int64_t utime_us) {
    return tenths(static_cast<double>(utime_us - begin_us) * 1e-6) + " s";
  };
  std::string text;
  std::size_t count = 0;
  for (const TimeSpan& span : without) {
    if (span.end_us - span.begin_us >= kLongSpanUs && ++count <= kMostSpans) {
      text += concat({count == 1 ? ", nothing from " : ", from ", seconds(span.begin_us), " to ",
                      seconds(span.end_us)});
    }
  }
  return count <= kMostSpans
             ? text
             : concat({text, " and ", counted(count - kMostSpans, "time"), " more"});
}

void say_gaps(const std::string& path, const std::vector<TimeSpan>& gaps,
              const std::vector<std::int64_t>& utime_us) {
  say_sparse(path, utime_us);
  if (gaps.empty()) {
    return;
  }
  double missing_s = 0.0;
  for (const TimeSpan& gap : gaps) {
    missing_s += static_cast<double>(gap.end_us - gap.begin_us) * 1e-6;
  }
  std::fprintf(stderr, "%s: %s s are missing%s\n", path.c_str(), tenths(missing_s).c_str(),
               told_spans(gaps, utime_us.front()).c_str());
}

std::string told_time(const TimeSpan& time) {
  return concat({"utime ", std::to_string(time.begin_us), " to ", std::to_string(time.end_us)});
}

std::string told_time(const std::vector<std::int64_t>& utime_us) {
  return told_time(TimeSpan{utime_us.front(), utime_us.back()});
}

}  // namespace cremed
