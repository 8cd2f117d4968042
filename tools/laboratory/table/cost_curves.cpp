// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/table/cost_curves.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <Eigen/Dense>

#include "cremed/estimator/cost/mixture.hpp"
#include "tools/eval/plane_motion.hpp"
#include "tools/eval/report_file.hpp"
#include "tools/laboratory/pairs/sum_approximation.hpp"

namespace cremed {
namespace {

constexpr double kRangeStdM = 0.2;
constexpr double kAcrossStdM = 0.2;
constexpr double kStepM = 0.01;
constexpr double kSpanM = 4.0;

/// Targets on the x axis at these ranges, with the same isotropic covariance.
TargetSet line_of_targets(const std::vector<double>& ranges_m) {
  TargetSet targets;
  for (const double range_m : ranges_m) {
    Detection detection;
    detection.range_m = range_m;
    detection.range_std_m = kRangeStdM;
    detection.azimuth_std_rad = kAcrossStdM / range_m;
    detection.doppler_std_mps = 1.0;
    targets.add(detection, Pose2{});
  }
  return targets;
}

double exact_cost(const TargetSet& previous, const TargetSet& current, double translation_m) {
  double cost = 0.0;
  for (const Target& target : current) {
    double sum = 0.0;
    for (const Target& other : previous) {
      const Eigen::Matrix2d covariance = covariance_matrix(target) + covariance_matrix(other);
      const Eigen::Vector2d error =
          position(target) + Eigen::Vector2d(translation_m, 0.0) - position(other);
      sum += std::exp(-0.5 * error.dot(covariance.inverse() * error)) /
             (2.0 * std::numbers::pi * std::sqrt(covariance.determinant()));
    }
    cost -= std::log(sum / static_cast<double>(previous.size()));
  }
  return cost;
}

double mixture_cost(Mixture& mixture, const TargetSet& current, double translation_m) {
  double cost = 0.0;
  for (const Target& target : current) {
    const Eigen::Vector2d point_m = position(target) + Eigen::Vector2d(translation_m, 0.0);
    cost += mixture.evaluate(point_m, target.covariance_m2).cost;
  }
  return cost;
}

void make_relative(std::vector<CostPoint>& points, double CostPoint::*member) {
  const auto lowest = std::ranges::min_element(points, {}, member);
  const double base = (*lowest).*member;
  for (CostPoint& point : points) {
    point.*member -= base;
  }
}

std::unique_ptr<Mixture> mixture_of(const TargetSet& targets, double ray_weight) {
  OutlierRayOptions options;
  options.weight = ray_weight;
  auto mixture = std::make_unique<Mixture>();
  mixture->assign(targets, OutlierRay(options, Pose2{}));
  return mixture;
}

}  // namespace

std::vector<CostPoint> cost_curves(bool outlier) {
  const TargetSet previous = line_of_targets({4.0, 5.2, 8.1});
  std::vector<double> current_m{4.05 - kCurveTruthM, 5.13 - kCurveTruthM, 8.17 - kCurveTruthM};
  if (outlier) {
    current_m.push_back(9.6);
  }
  const TargetSet current = line_of_targets(current_m);
  const auto plain = mixture_of(previous, 0.0);
  const auto with_ray = mixture_of(previous, 0.2);
  RegistrationContext context;
  context.options.doppler.enabled = false;

  std::vector<CostPoint> points;
  const auto steps = std::lround(kSpanM / kStepM);
  for (long i = 0; i <= steps; ++i) {
    const double x_m = kCurveTruthM - 0.5 * kSpanM + kStepM * static_cast<double>(i);
    points.push_back(
        {x_m, exact_cost(previous, current, x_m),
         sum_approximation_cost(previous, current, context, Eigen::Vector3d(x_m, 0.0, 0.0)),
         mixture_cost(*plain, current, x_m), mixture_cost(*with_ray, current, x_m)});
  }
  for (const auto member : {&CostPoint::likelihood, &CostPoint::sum_approximation, &CostPoint::msm,
                            &CostPoint::msm_with_ray}) {
    make_relative(points, member);
  }
  return points;
}

void write_cost_csv(const std::string& path) {
  ReportFile file(path);
  file.print("outlier,truth_m,translation_m,likelihood,sum_approximation,msm,msm_with_ray\n");
  for (const bool outlier : {false, true}) {
    for (const CostPoint& p : cost_curves(outlier)) {
      file.print("{},{:.3f},{:.3f},{:.6f},{:.6f},{:.6f},{:.6f}\n", outlier ? 1 : 0, kCurveTruthM,
                 p.translation_m, p.likelihood, p.sum_approximation, p.msm, p.msm_with_ray);
    }
  }
  file.close();
}

}  // namespace cremed
