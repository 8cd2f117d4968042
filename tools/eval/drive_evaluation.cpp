// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive_evaluation.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <stdexcept>

#include "tools/eval/csv_table.hpp"

namespace cremed {
namespace {

struct Estimate {
  std::int64_t start_us = 0;
  std::int64_t end_us = 0;
  Eigen::Vector3d motion;
  Eigen::Matrix3d covariance;
};

struct SourceRows {
  std::string source;
  std::vector<Estimate> estimates;
  std::size_t without_estimate = 0;
};

bool is_estimate(const std::string& status) { return status == "ok" || status == "standing_still"; }

Estimate read_estimate(const CsvTable& table, std::size_t row) {
  const auto number = [&](const char* name) { return table.number(row, table.column(name)); };
  Estimate estimate;
  estimate.start_us = table.integer(row, table.column("utime_start"));
  estimate.end_us = table.integer(row, table.column("utime"));
  estimate.motion << number("x_m"), number("y_m"), number("yaw_rad");
  const double xy = number("cov_xy");
  const double xyaw = number("cov_xyaw");
  const double yyaw = number("cov_yyaw");
  estimate.covariance << number("cov_xx"), xy, xyaw,  //
      xy, number("cov_yy"), yyaw,                     //
      xyaw, yyaw, number("cov_yawyaw");
  if (!estimate.motion.allFinite() || !estimate.covariance.allFinite()) {
    throw std::runtime_error("row " + std::to_string(row + 1) + ": an estimate that is not finite");
  }
  return estimate;
}

std::vector<SourceRows> read_odometry(std::istream& input) {
  const CsvTable table(input);
  const std::size_t source = table.column("source");
  const std::size_t status = table.column("status");
  std::vector<SourceRows> sources;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string& name = table.text(row, source);
    auto rows = std::find_if(sources.begin(), sources.end(),
                             [&](const SourceRows& s) { return s.source == name; });
    if (rows == sources.end()) {
      rows = sources.insert(sources.end(), SourceRows{name, {}, 0});
    }
    if (is_estimate(table.text(row, status))) {
      rows->estimates.push_back(read_estimate(table, row));
    } else {
      ++rows->without_estimate;
    }
  }
  return sources;
}

SourceEvaluation evaluate_source(const SourceRows& rows, const TrueTrajectory& truth) {
  const bool two_dof = std::all_of(rows.estimates.begin(), rows.estimates.end(),
                                   [](const Estimate& e) { return e.covariance(1, 1) == 0.0; });
  SourceEvaluation result{rows.source, Credibility(two_dof ? 2 : 3), rows.without_estimate, 0};
  for (const Estimate& estimate : rows.estimates) {
    if (const auto motion = truth.motion(estimate.start_us, estimate.end_us)) {
      result.credibility.add(estimate.motion, estimate.covariance, *motion);
    } else {
      ++result.outside_truth;
    }
  }
  return result;
}

}  // namespace

std::vector<SourceEvaluation> evaluate_drive(std::istream& odometry, const TrueTrajectory& truth) {
  std::vector<SourceEvaluation> result;
  for (const SourceRows& rows : read_odometry(odometry)) {
    result.push_back(evaluate_source(rows, truth));
  }
  return result;
}

}  // namespace cremed
