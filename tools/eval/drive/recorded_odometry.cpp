// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/recorded_odometry.hpp"

#include <algorithm>

#include "tools/eval/csv_matrix.hpp"

namespace cremed {
namespace {

RecordedEstimate read_estimate(const CsvTable& table, std::size_t row) {
  return {table.integer(row, table.column("utime_start")),
          table.integer(row, table.column("utime")), read_vector(table, row, kPoseColumns),
          read_symmetric(table, row, kPoseCovarianceColumns)};
}

RecordedOdometry& odometry_of(std::vector<RecordedOdometry>& sources, const std::string& name) {
  const auto found = std::find_if(sources.begin(), sources.end(),
                                  [&](const RecordedOdometry& s) { return s.source == name; });
  return found != sources.end() ? *found : sources.emplace_back(RecordedOdometry{name, {}, 0});
}

}  // namespace

bool is_estimate(const std::string& status) { return status == "ok" || status == "standing_still"; }

std::vector<RecordedOdometry> read_odometry(const CsvTable& table) {
  const std::size_t source = table.column("source");
  const std::size_t status = table.column("status");
  std::vector<RecordedOdometry> sources;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    RecordedOdometry& odometry = odometry_of(sources, table.text(row, source));
    if (is_estimate(table.text(row, status))) {
      odometry.estimates.push_back(read_estimate(table, row));
    } else {
      ++odometry.without_estimate;
    }
  }
  return sources;
}

int degrees_of_freedom(const RecordedOdometry& odometry) {
  const bool two_dof =
      std::all_of(odometry.estimates.begin(), odometry.estimates.end(),
                  [](const RecordedEstimate& e) { return e.covariance(1, 1) == 0.0; });
  return two_dof ? 2 : 3;
}

}  // namespace cremed
