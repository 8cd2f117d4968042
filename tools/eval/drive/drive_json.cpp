// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/drive_json.hpp"

#include <nlohmann/json.hpp>

#include "tools/eval/drive/trajectory_error.hpp"

namespace cremed {
namespace {

/// Keeps the order of members; NaN becomes null.
using Json = nlohmann::ordered_json;

/// For 1, 2 and 3 sigma.
Json coverage_json(const Credibility& credibility, int axis) {
  return Json::array({credibility.coverage(axis, 1), credibility.coverage(axis, 2),
                      credibility.coverage(axis, 3)});
}

Json vector_json(const Eigen::Vector3d& v) { return Json::array({v.x(), v.y(), v.z()}); }

Json to_json(const PathDrift& drift) {
  return {{"length_m", drift.length_m},
          {"segments", drift.segments},
          {"across_gaps", drift.across_gaps},
          {"translation_percent", drift.translation_percent},
          {"rotation_deg_per_m", drift.rotation_deg_per_m}};
}

Json to_json(const SegmentErrors& errors) {
  return {{"after", to_text(errors.length)},
          {"segments", errors.segments},
          {"rmse_m_m_rad", vector_json(errors.rmse)},
          {"position_percent", errors.position_percent},
          {"chains", errors.chains},
          {"anees", errors.anees},
          {"nees_x_y_yaw", vector_json(errors.nees)}};
}

Json to_json(const AxisAgainstWheels& axis) {
  return {{"n", axis.count},
          {"nees", axis.nees},
          {"nees_estimate", axis.nees_estimate},
          {"nees_truth", axis.nees_truth},
          {"nees_cross", axis.nees_cross},
          {"nees_against_truth", axis.nees_against_truth()},
          {"rms_estimate_per_s", axis.rms_estimate_per_s},
          {"rms_truth_per_s", axis.rms_truth_per_s},
          {"rms_both_per_s", axis.rms_both_per_s}};
}

Json to_json(const TwistAgainstWheels& twist) {
  return {{"n", twist.count},
          {"nees_speed", twist.nees_speed},
          {"nees_yaw_rate", twist.nees_yaw_rate},
          {"rms_speed_mps", twist.rms_speed_mps},
          {"rms_yaw_rate_radps", twist.rms_yaw_rate_radps}};
}

Json to_json(const TruthAgainstWheels& truth) {
  return {{"interval_s", truth.interval_s},
          {"intervals", truth.count},
          {"rms_x_m", truth.rms_x_m},
          {"rms_y_m", truth.rms_y_m},
          {"rms_yaw_rad", truth.rms_yaw_rad}};
}

Json to_json(const TimeSpan& gap) { return {{"begin_us", gap.begin_us}, {"end_us", gap.end_us}}; }

Json to_json(const RelativePoseStd& std) {
  return {
      {"x_m", std.x_m}, {"y_m", std.y_m}, {"yaw_rad", std.yaw_rad}, {"interval_s", std.interval_s}};
}

Json to_json(const TrajectoryError& error) {
  return {{"from_begin_m", error.from_begin_m}, {"aligned_m", error.aligned_m}};
}

Json to_json(const SourceEvaluation& source);

template <typename Row>
Json rows_json(const std::vector<Row>& rows) {
  Json array = Json::array();
  for (const Row& row : rows) {
    array.push_back(to_json(row));
  }
  return array;
}

Json to_json(const SourceEvaluation& source) {
  Json json{{"source", source.source}, {"degrees_of_freedom", source.degrees_of_freedom}};
  json.update(credibility_json(source.credibility));
  json.update({{"availability_percent", source.availability.percent},
               {"without_estimate", source.without_estimate},
               {"outside_truth", source.outside_truth},
               {"gaps", source.path.empty() ? 0 : source.path.back().gaps},
               {"trajectory_error", to_json(trajectory_error(source.path))},
               {"drift", rows_json(source.drift)},
               {"mean_drift", to_json(mean_drift(source.drift))},
               {"segments", rows_json(source.segments)}});
  if (source.wheels) {
    json["wheels"] = {{"x", to_json(source.wheels->x)}, {"yaw", to_json(source.wheels->yaw)}};
  }
  if (source.twist) {
    json["twist"] = to_json(*source.twist);
  }
  return json;
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

void print_json(std::FILE* file, const std::vector<SourceEvaluation>& sources,
                const DriveReference& reference, const std::vector<TruthAgainstWheels>& truth) {
  Json json{{"sources", rows_json(sources)},
            {"truth_std", rows_json(reference.truth_noise.stds())},
            {"truth_gaps", rows_json(reference.truth.gaps())}};
  if (reference.wheels) {
    json["wheels_std"] = {{"speed_mps", reference.wheels->std().speed_mps},
                          {"yaw_rate_radps", reference.wheels->std().yaw_rate_radps}};
    json["wheels_gaps"] = rows_json(reference.wheels->gaps());
    json["truth_against_wheels"] = rows_json(truth);
  }
  std::fprintf(file, "%s\n", json.dump(2).c_str());
}

}  // namespace cremed
