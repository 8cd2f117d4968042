// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/pairs/correspondence_counts.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "tools/eval/plane_motion.hpp"
#include "tools/eval/report_file.hpp"
#include "tools/laboratory/pairs/pairs_evaluation.hpp"

namespace cremed {
namespace {

constexpr double kMaxDistance = 1.0;

}  // namespace

double bhattacharyya_distance(const Eigen::Vector2d& difference, const Eigen::Matrix2d& a,
                              const Eigen::Matrix2d& b) {
  const Eigen::Matrix2d mean = 0.5 * (a + b);
  return 0.125 * difference.dot(mean.inverse() * difference) +
         0.5 * std::log(mean.determinant() / std::sqrt(a.determinant() * b.determinant()));
}

CorrespondenceCounts count_correspondences(const RegistrationPair& pair) {
  const TargetSet previous = to_targets(pair.previous, pair.vehicle_from_radar);
  const TargetSet current = to_targets(pair.current, pair.vehicle_from_radar);
  const Eigen::Matrix2d rotation = rotation_matrix(pair.truth.yaw_rad);
  const Eigen::Vector2d translation_m(pair.truth.x_m, pair.truth.y_m);
  CorrespondenceCounts counts;
  for (const Target& target : current) {
    const Eigen::Vector2d point_m = rotation * position(target) + translation_m;
    const Eigen::Matrix2d covariance = rotation * covariance_matrix(target) * rotation.transpose();
    const bool has_partner = std::ranges::any_of(previous, [&](const Target& other) {
      return bhattacharyya_distance(point_m - position(other), covariance,
                                    covariance_matrix(other)) < kMaxDistance;
    });
    ++(has_partner ? counts.correspondences : counts.outliers);
  }
  return counts;
}

void write_correspondences_csv(const std::string& path,
                               const std::vector<RegistrationPair>& pairs) {
  ReportFile file(path);
  file.print("pair,correspondences,outliers\n");
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const CorrespondenceCounts counts = count_correspondences(pairs[i]);
    file.print("{},{},{}\n", i, counts.correspondences, counts.outliers);
  }
  file.close();
}

}  // namespace cremed
