// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/figures_json.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

#include "cremed/estimator/scan/degrees.hpp"
#include "tools/eval/drive/drive_json.hpp"

namespace cremed {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Figures& figures) {
  return {{"rmse_m", figures.rmse_m}, {"rmse_deg", figures.rmse_deg}, {"anees", figures.anees}};
}

Json to_json(const Interval& interval) { return Json::array({interval.low, interval.high}); }

Json to_json(const TableRow& row) {
  return {{"problem", row.problem},
          {"method", row.method},
          {"degrees_of_freedom", row.credibility.degrees_of_freedom()},
          {"n", row.credibility.count()},
          {"ours", to_json(figures_of(row.credibility))},
          {"consistent_anees", to_json(consistent_anees(row.credibility))},
          {"iterations", row.iterations},
          {"ms_pair", 1e-3 * row.solve_us},
          {"left_out", row.left_out},
          {"ambiguous", row.ambiguous},
          {"no_convergence", row.no_convergence},
          {"nees_above_25", row.gross},
          {"paper", to_json(row.paper)},
          {"bound", to_json(row.bound)}};
}

Json to_json(const RealRow& row) {
  return {{"problem", row.problem},
          {"method", row.method},
          {"is_simulated", row.problem == "Robot"},
          {"n", row.credibility.count()},
          {"left_out", row.left_out},
          {"ours", to_json(figures_of(row.credibility))},
          {"consistent_anees", to_json(consistent_anees(row.credibility))},
          {"paper", to_json(row.paper)},
          {"paper_trainval", to_json(row.paper_850)}};
}

Json to_json(const RealTable::Odometry& row) {
  const SegmentErrors& errors = row.errors;
  return {{"problem", row.problem},
          {"time_s", errors.length.time_s},
          {"segments", errors.segments},
          {"rmse_m", std::hypot(errors.rmse.x(), errors.rmse.y())},
          {"rmse_deg", errors.rmse.z() * kDegPerRad},
          {"anees", errors.anees},
          {"percent_of_way", errors.position_percent}};
}

}  // namespace

std::string pairs_json(const std::string& method, const PairsFigures& figures) {
  Json json{{"method", method}};
  json.update(credibility_json(figures.credibility));
  json.update({{"iterations", figures.iterations},
               {"solve_us", figures.solve_us},
               {"no_convergence", figures.no_convergence},
               {"left_out", figures.left_out}});
  return json.dump(2);
}

std::string table_json(const std::vector<TableRow>& rows) {
  Json json{{"rows", Json::array()}};
  for (const TableRow& row : rows) {
    json["rows"].push_back(to_json(row));
  }
  return json.dump(2);
}

std::string real_table_json(const RealTable& table) {
  Json json{{"drives", table.drives},
            {"note", table.note},
            {"rows", Json::array()},
            {"odometry", Json::array()}};
  for (const RealRow& row : table.rows) {
    json["rows"].push_back(to_json(row));
  }
  for (const RealTable::Odometry& row : table.odometry) {
    json["odometry"].push_back(to_json(row));
  }
  return json.dump(2);
}

}  // namespace cremed
