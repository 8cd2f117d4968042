// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/pairs/known_correspondences.hpp"

#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "cremed/estimator/cost/doppler.hpp"
#include "cremed/estimator/cost/normal_equations.hpp"
#include "cremed/estimator/scan/target_set.hpp"
#include "tools/eval/plane_motion.hpp"
#include "tools/laboratory/pairs/pairs_evaluation.hpp"

namespace cremed {
namespace {

constexpr int kMaxSteps = 50;
constexpr double kStepTolerance = 1e-10;  // squared, in standard deviations

struct Problem {
  TargetSet previous;
  TargetSet current;
  std::vector<std::pair<std::size_t, std::size_t>> matches;  // index in previous, in current
};

Problem prepare(const RegistrationPair& pair) {
  Problem problem{to_targets(pair.previous, pair.vehicle_from_radar),
                  to_targets(pair.current, pair.vehicle_from_radar),
                  {}};
  for (std::size_t i = 0; i < problem.current.size(); ++i) {
    for (std::size_t j = 0; j < problem.previous.size(); ++j) {
      if (pair.current[i].id == pair.previous[j].id) {
        problem.matches.emplace_back(j, i);
      }
    }
  }
  return problem;
}

void add_match(const Target& previous, const Target& current, const Eigen::Vector3d& motion,
               NormalEquations& equations) {
  const Eigen::Matrix2d rotation = rotation_matrix(motion.z());
  const Eigen::Vector2d rotated = rotation * position(current);
  const Eigen::Vector2d error = rotated + motion.head<2>() - position(previous);
  const Eigen::Matrix2d weight =
      (covariance_matrix(previous) + rotation * covariance_matrix(current) * rotation.transpose())
          .inverse();
  equations.add_point({weight(0, 0), weight(0, 1), weight(1, 1)}, weight * error, rotated);
  equations.cost += 0.5 * error.dot(weight * error);
}

NormalEquations linearise(const Problem& problem, const RegistrationPair& pair,
                          const DopplerOptions& doppler, const Eigen::Vector3d& motion) {
  NormalEquations equations;
  for (const auto& [j, i] : problem.matches) {
    add_match(problem.previous[j], problem.current[i], motion, equations);
  }
  if (doppler.enabled) {
    const Eigen::Matrix3d by_motion = doppler_by_motion(pair.vehicle_from_radar);
    const DopplerSums sums = sum_doppler(problem.current, by_motion.transpose() * motion,
                                         Eigen::Vector3d::Zero(), pair.dt_s, doppler, 1.0);
    equations.information += by_motion * sums.products * by_motion.transpose();
    equations.gradient += by_motion * sums.errors;
    equations.cost += sums.cost;
  }
  return equations;
}

}  // namespace

RegistrationResult register_known(const RegistrationPair& pair,
                                  const RegistrationOptions& options) {
  const Problem problem = prepare(pair);
  DopplerOptions doppler = options.doppler;
  doppler.moving_weight = 0.0;
  RegistrationResult result;
  result.status = RegistrationStatus::no_convergence;
  for (; result.iterations < kMaxSteps; ++result.iterations) {
    const NormalEquations equations = linearise(problem, pair, doppler, result.motion);
    const auto inverse = invert_information(equations.information, options.degrees_of_freedom);
    if (!inverse) {
      result.status = RegistrationStatus::degenerate;
      break;
    }
    result.covariance = *inverse;
    result.cost = equations.cost;
    const Eigen::Vector3d step = -*inverse * equations.gradient;
    if (step.dot(-equations.gradient) < kStepTolerance) {
      result.status = RegistrationStatus::converged;
      break;
    }
    result.motion += step;
  }
  return result;
}

}  // namespace cremed
