// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/cost/exclusive_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cremed/estimator/cost/exponentiate.hpp"
#include "cremed/estimator/scan/rotation.hpp"

namespace cremed {
namespace {

/// Pairs with a smaller psi are left out. As p <= psi, each of them has less than 0.1 % of a
/// target's weight.
constexpr double kMinRatio = 1e-3;
/// Upper bound of P_d: one of 20 targets is hidden or too weak in the next scan even if nothing
/// moves.
constexpr double kMaxDetectionProbability = 0.95;
/// Density of new targets without an outlier ray, per square metre and target, times 2 pi: uniform
/// over 6 km^2, 20 times the area within 300 m. A target then counts as new only if it is more than
/// 5 sigma from all others.
constexpr double kClutterPerM2 = 1e-6;

/// Rounds of the association in steps before the last. Convergence takes 13 rounds on average and
/// often 32 (nuScenes 0103), a fifth of a registration's time, and gives the same motions.
constexpr int kRoundsPerStep = 8;
/// And their tolerance: a fiftieth of a target's weight.
constexpr double kToleranceOfStep = 0.02;

/// Work to evaluate a pair, in evaluations of a mixture component. An estimate: the limit of the
/// work is a count, not a time.
constexpr std::int64_t kPairWork = 4;

/// 2 pi N(e; C), given C^-1.
double scaled_density(const Eigen::Vector2d& e, const Symmetric2& information) {
  return std::sqrt(information.determinant()) * std::exp(-0.5 * e.dot(information * e));
}

/// sum_k w_k N(m_i - ray_k; S_ray,k + S_i), times 2 pi.
double new_target_density(const Target& target, const OutlierRay& ray) {
  double density = ray.size() == 0 ? kClutterPerM2 : 0.0;
  for (const RayComponent& component : ray) {
    density += component.weight *
               scaled_density({target.x_m - component.x_m, target.y_m - component.y_m},
                              (component.covariance_m2 + target.covariance_m2).inverse());
  }
  return density;
}

/// The target in the frame of the previous scan. `lever_m`: its point without the translation.
Target move(const Target& target, const Rotation& rotation, const Eigen::Vector3d& motion,
            Eigen::Vector2d& lever_m) {
  lever_m = rotation * Eigen::Vector2d(target.x_m, target.y_m);
  Target moved;
  moved.x_m = lever_m.x() + motion.x();
  moved.y_m = lever_m.y() + motion.y();
  moved.covariance_m2 = rotation * target.covariance_m2;
  return moved;
}

}  // namespace

void ExclusiveLikelihood::assign(const TargetSet& previous, const TargetSet& current,
                                 const OutlierRay& ray) {
  const auto n = static_cast<double>(current.size());
  const double seen_again = (1.0 - ray.weight()) * n / static_cast<double>(previous.size());
  const double probability = std::min(seen_again, kMaxDetectionProbability);
  for (std::size_t i = 0; i < current.size(); ++i) {
    const double scale =
        probability / (1.0 - probability) / (n * new_target_density(current[i], ray));
    ratio_scale_m2_[i] = scale;
    // det(C_ij) >= det(S_i), so that psi_ij <= scale / sqrt(det(S_i)) exp(-distance^2 / 2).
    const double nearest_ratio = scale / std::sqrt(current[i].covariance_m2.determinant());
    max_squared_distance_[i] = 2.0 * std::log(std::max(nearest_ratio / kMinRatio, 1.0));
  }
  sort(previous);
  candidate_begin_[0] = 0;
  matched_ = 0.0;
  evaluations_ = static_cast<std::int64_t>(current.size() * ray.size());
}

void ExclusiveLikelihood::sort(const TargetSet& previous) {
  const std::size_t size = previous.size();
  std::iota(sorted_.begin(), sorted_.begin() + static_cast<std::ptrdiff_t>(size), 0);
  std::sort(sorted_.begin(), sorted_.begin() + static_cast<std::ptrdiff_t>(size),
            [&](std::uint16_t a, std::uint16_t b) { return previous[a].x_m < previous[b].x_m; });
  max_variance_x_m2_ = 0.0;
  for (std::size_t k = 0; k < size; ++k) {
    const Target& target = previous[sorted_[k]];
    x_m_[k] = target.x_m;
    y_m_[k] = target.y_m;
    variance_m2_[k] = target.covariance_m2.trace();
    max_variance_x_m2_ = std::max(max_variance_x_m2_, target.covariance_m2.xx);
  }
}

/// Prefilters by lower bounds of the squared Mahalanobis distance: ex^2 / C_xx with the largest
/// C_xx, which is a range of the sorted targets, and e'e / trace(C).
bool ExclusiveLikelihood::list_row(std::size_t i, const TargetSet& previous, const Target& moved) {
  const double x_m = moved.x_m;
  const double y_m = moved.y_m;
  const double variance_m2 = moved.covariance_m2.trace();
  const double max_distance = std::sqrt(max_squared_distance_[i]) + kListMarginSigmas;
  const double max_squared_distance = max_distance * max_distance;
  const double reach_m = max_distance * std::sqrt(max_variance_x_m2_ + moved.covariance_m2.xx);
  const double* const all = x_m_.data();
  const double* const begin = std::lower_bound(all, all + previous.size(), x_m - reach_m);
  const double* const end = std::upper_bound(begin, all + previous.size(), x_m + reach_m);
  const auto first = static_cast<std::size_t>(begin - all);
  const auto last = static_cast<std::size_t>(end - all);
  for (std::size_t k = first; k < last; ++k) {
    const double ex = x_m - x_m_[k];
    const double ey = y_m - y_m_[k];
    excess_m2_[k] = ex * ex + ey * ey - max_squared_distance * (variance_m2_[k] + variance_m2);
  }
  // Without branches, because they would be unpredictable.
  std::size_t near = 0;
  for (std::size_t k = first; k < last; ++k) {
    near_[near] = static_cast<std::uint16_t>(k);
    near += excess_m2_[k] <= 0.0 ? 1U : 0U;
  }
  std::size_t count = candidate_begin_[i];
  for (std::size_t n = 0; n < near; ++n) {
    const std::uint16_t k = near_[n];
    const std::uint16_t j = sorted_[k];
    const Symmetric2 covariance = previous[j].covariance_m2 + moved.covariance_m2;
    if (covariance.inverse().quadratic(x_m - x_m_[k], y_m - y_m_[k]) <= max_squared_distance) {
      if (count == candidates_.size()) {
        return false;
      }
      candidates_[count++] = j;
    }
  }
  candidate_begin_[i + 1] = count;
  return true;
}

bool ExclusiveLikelihood::list_pairs(const TargetSet& previous, const TargetSet& current,
                                     const Eigen::Vector3d& motion) {
  const Rotation rotation(motion.z());
  is_new_ = true;
  matched_ = 0.0;
  evaluations_ += static_cast<std::int64_t>(current.size() * previous.size());
  for (std::size_t i = 0; i < current.size(); ++i) {
    if (!list_row(i, previous, move(current[i], rotation, motion, lever_m_[i]))) {
      std::fill(candidate_begin_.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                candidate_begin_.end(), candidate_begin_[i]);
      return false;
    }
  }
  return true;
}

void ExclusiveLikelihood::add_pair(std::size_t i, std::size_t j, const Target& previous,
                                   const Target& moved, const Eigen::Vector2d& lever_m) {
  const double ex = moved.x_m - previous.x_m;
  const double ey = moved.y_m - previous.y_m;
  const Symmetric2 information = (previous.covariance_m2 + moved.covariance_m2).inverse();
  const double squared_distance = information.quadratic(ex, ey);
  if (squared_distance > max_squared_distance_[i]) {
    return;
  }
  const Eigen::Vector2d pull = information * Eigen::Vector2d(ex, ey);
  const double greatest_ratio = ratio_scale_m2_[i] * std::sqrt(information.determinant());
  const std::size_t k = association_.size();
  terms_[k] = {information, pull.x(), pull.y(), greatest_ratio};
  exponents_[k] = -0.5 * squared_distance;
  association_.add(j, greatest_ratio, along_states(pull, lever_m));
}

/// All at once, because exponentials are faster then.
void ExclusiveLikelihood::set_ratios() {
  const std::size_t size = association_.size();
  exponentiate({exponents_.data(), size});
  for (std::size_t k = 0; k < size; ++k) {
    association_.set_ratio(k, terms_[k].greatest_ratio * exponents_[k]);
  }
}

NormalEquations ExclusiveLikelihood::linearise(const TargetSet& previous, const TargetSet& current,
                                               const Eigen::Vector3d& motion, bool settle) {
  const Rotation rotation(motion.z());
  association_.clear(previous.size());
  for (std::size_t i = 0; i < current.size(); ++i) {
    association_.begin_row();
    if (candidate_begin_[i] == candidate_begin_[i + 1]) {
      continue;
    }
    const Target moved = move(current[i], rotation, motion, lever_m_[i]);
    for (std::size_t k = candidate_begin_[i]; k < candidate_begin_[i + 1]; ++k) {
      add_pair(i, candidates_[k], previous[candidates_[k]], moved, lever_m_[i]);
    }
  }
  set_ratios();
  if (is_new_) {
    association_.start();
    is_new_ = false;
  }
  const auto rounds = static_cast<std::int64_t>(
      settle ? association_.solve() : association_.solve(kRoundsPerStep, kToleranceOfStep));
  evaluations_ += kPairWork * static_cast<std::int64_t>(candidate_begin_[current.size()]) +
                  rounds * static_cast<std::int64_t>(association_.size());
  return sum_up();
}

NormalEquations ExclusiveLikelihood::sum_up() {
  NormalEquations equations;
  matched_ = 0.0;
  for (std::size_t i = 0; i < association_.rows(); ++i) {
    Symmetric2 information;
    Eigen::Vector2d pull = Eigen::Vector2d::Zero();
    for (std::size_t k = association_.row_begin(i); k < association_.row_begin(i + 1); ++k) {
      const double p = association_.probability(k);
      const Term& term = terms_[k];
      information = information + p * term.information;
      pull += p * Eigen::Vector2d(term.x_per_m, term.y_per_m);
      matched_ += p;
    }
    equations.add_point(information, pull, lever_m_[i]);
  }
  equations.cost = association_.cost();
  return equations;
}

}  // namespace cremed
