// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/figures_json.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

#include "cremed/estimator/scan/degrees.hpp"

namespace cremed {
namespace {

using Json = nlohmann::ordered_json;

/// For 1, 2 and 3 sigma.
Json coverage_json(const Credibility& credibility, int axis) {
  return Json::array({credibility.coverage(axis, 1), credibility.coverage(axis, 2),
                      credibility.coverage(axis, 3)});
}

Json to_json(const Figures& figures) {
  return {{"rmse_m", figures.rmse_m}, {"rmse_deg", figures.rmse_deg}, {"anees", figures.anees}};
}

Json to_json(const TableRow& row) {
  return {{"problem", row.problem},
          {"method", row.method},
          {"degrees_of_freedom", row.degrees_of_freedom},
          {"n", row.count},
          {"ours", to_json(row.ours)},
          {"consistent_anees", Json::array({row.consistent.low, row.consistent.high})},
          {"iterations", row.iterations},
          {"ms_pair", row.milliseconds},
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
          {"n", row.count},
          {"left_out", row.left_out},
          {"ours", to_json(row.ours)},
          {"consistent_anees", Json::array({row.consistent.low, row.consistent.high})},
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

Json credibility_json(const Credibility& c) {
  return {{"n", c.count()},
          {"rmse_m", c.rmse_m()},
          {"rmse_deg", c.rmse_deg()},
          {"anees", c.anees()},
          {"coverage_x", coverage_json(c, 0)},
          {"coverage_y", coverage_json(c, 1)},
          {"coverage_yaw", coverage_json(c, 2)}};
}

std::string pairs_json(const PairsFigures& figures) {
  Json json{{"method", figures.method}};
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
