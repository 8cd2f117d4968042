// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/recorded_odometry.hpp"

#include <algorithm>
#include <utility>

#include "tools/eval/csv_table.hpp"

namespace cremed {
namespace {

std::vector<std::int64_t> times_of(const std::vector<RowTime>& rows) {
  std::vector<std::int64_t> utime_us(rows.size());
  std::ranges::transform(rows, utime_us.begin(), &RowTime::utime_us);
  return utime_us;
}

void add_span(const TimeSpan& span, std::vector<TimeSpan>& spans) {
  if (span.begin_us >= span.end_us) {
    return;
  }
  if (!spans.empty() && spans.back().end_us == span.begin_us) {
    spans.back().end_us = span.end_us;
  } else {
    spans.push_back(span);
  }
}

RecordedEstimate read_estimate(const CsvTable& table, std::size_t row) {
  return {table.integer(row, table.column("utime_start")),
          table.integer(row, table.column("utime")), read_vector(table, row, kPoseColumns),
          read_symmetric(table, row, kPoseCovarianceColumns)};
}

/// A source's rows.
struct SourceRows {
  RecordedOdometry odometry;
  std::vector<RowTime> times;
};

SourceRows& rows_of(std::vector<SourceRows>& sources, const std::string& name) {
  const auto found =
      std::ranges::find_if(sources, [&](const SourceRows& s) { return s.odometry.source == name; });
  return found != sources.end() ? *found : sources.emplace_back(SourceRows{{name, {}, 0}, {}});
}

}  // namespace

Availability availability(const std::vector<RowTime>& rows, const TimeSpan& drive) {
  Availability result;
  const std::int64_t longest_us = longest_step_us(times_of(rows));
  std::int64_t told_us = drive.begin_us;
  for (const RowTime& row : rows) {
    const std::int64_t utime_us = std::min(row.utime_us, drive.end_us);
    if (!row.is_usable || utime_us - told_us > longest_us) {
      add_span({told_us, utime_us}, result.without);
    }
    told_us = std::max(told_us, utime_us);
  }
  add_span({told_us, drive.end_us}, result.without);
  if (drive.end_us > drive.begin_us) {
    std::int64_t without_us = 0;
    for (const TimeSpan& span : result.without) {
      without_us += span.end_us - span.begin_us;
    }
    result.percent = 100.0 - 100.0 * static_cast<double>(without_us) /
                                 static_cast<double>(drive.end_us - drive.begin_us);
  }
  return result;
}

bool is_estimate(std::string_view status) { return status == "ok" || status == "standing_still"; }

TimeSpan time_of(const CsvTable& table) {
  const std::size_t utime = table.column("utime");
  TimeSpan span;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::int64_t utime_us = table.integer(row, utime);
    span = row == 0 ? TimeSpan{utime_us, utime_us}
                    : TimeSpan{std::min(span.begin_us, utime_us), std::max(span.end_us, utime_us)};
  }
  return span;
}

std::vector<RecordedOdometry> read_odometry(const CsvTable& table) {
  const std::size_t source = table.column("source");
  const std::size_t status = table.column("status");
  const std::size_t utime = table.column("utime");
  std::vector<SourceRows> sources;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    auto& [odometry, times] = rows_of(sources, table.text(row, source));
    times.push_back({table.integer(row, utime), is_estimate(table.text(row, status))});
    if (times.back().is_usable) {
      odometry.estimates.push_back(read_estimate(table, row));
    } else {
      ++odometry.without_estimate;
    }
  }
  const TimeSpan drive = time_of(table);
  std::vector<RecordedOdometry> result;
  for (auto& [odometry, times] : sources) {
    odometry.availability = availability(times, drive);
    result.push_back(std::move(odometry));
  }
  return result;
}

int degrees_of_freedom(const RecordedOdometry& odometry) {
  const bool two_dof = std::ranges::all_of(
      odometry.estimates, [](const RecordedEstimate& e) { return e.covariance(1, 1) == 0.0; });
  return two_dof ? 2 : 3;
}

}  // namespace cremed
