// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/pairs/icp.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "cremed/estimator/cost/normal_equations.hpp"
#include "tools/eval/plane_motion.hpp"

namespace cremed {
namespace {

const Target& nearest(const TargetSet& targets, const Eigen::Vector2d& point_m) {
  return *std::ranges::min_element(targets, [&](const Target& a, const Target& b) {
    return (position(a) - point_m).squaredNorm() < (position(b) - point_m).squaredNorm();
  });
}

constexpr int kMaxIterations = 50;         // the paper's
constexpr double kStepTolerance2 = 1e-12;  // squared, m and rad

using Points = Eigen::Matrix2Xd;

Points to_points(const TargetSet& targets) {
  Points points(2, targets.size());
  Eigen::Index column = 0;
  for (const Target& target : targets) {
    points.col(column++) = position(target);
  }
  return points;
}

Points nearest_of(const Points& candidates, const Points& points) {
  Points nearest(2, points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    Eigen::Index best = 0;
    (candidates.colwise() - points.col(i)).colwise().squaredNorm().minCoeff(&best);
    nearest.col(i) = candidates.col(best);
  }
  return nearest;
}

/// The least-squares motion of points onto their partners, in closed form (Umeyama 1991).
Eigen::Isometry2d best_motion(const Points& points, const Points& partners) {
  const Eigen::Vector2d from_m = points.rowwise().mean();
  const Eigen::Vector2d to_m = partners.rowwise().mean();
  const Eigen::Matrix2d correlation =
      (points.colwise() - from_m) * (partners.colwise() - to_m).transpose();
  const double yaw_rad = std::atan2(correlation(0, 1) - correlation(1, 0), correlation.trace());
  return Eigen::Translation2d(to_m) * Eigen::Rotation2Dd(yaw_rad) * Eigen::Translation2d(-from_m);
}

double yaw_of(const Eigen::Isometry2d& motion) { return std::atan2(motion(1, 0), motion(0, 0)); }

bool is_small(const Eigen::Isometry2d& step) {
  const double yaw_rad = yaw_of(step);
  return step.translation().squaredNorm() <= kStepTolerance2 &&
         yaw_rad * yaw_rad <= kStepTolerance2;
}

Eigen::Isometry2d search(const Points& previous, const Points& current, int& iterations) {
  Eigen::Isometry2d motion = Eigen::Isometry2d::Identity();
  for (iterations = 0; iterations < kMaxIterations;) {
    const Points moved = motion * current;
    const Eigen::Isometry2d step = best_motion(moved, nearest_of(previous, moved));
    motion = step * motion;
    ++iterations;
    if (is_small(step)) {
      break;
    }
  }
  return motion;
}

}  // namespace

std::optional<Eigen::Matrix3d> icp_covariance(const TargetSet& previous, const TargetSet& current,
                                              const Eigen::Vector3d& motion) {
  // With a = R p, e = a + t - q and a' = (-a_y, a_x) = da/dyaw: dJ/dt = e, dJ/dyaw = e . a'.
  const Eigen::Matrix2d rotation = rotation_matrix(motion.z());
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Target& target : current) {
    const Eigen::Vector2d a = rotation * position(target);
    const Eigen::Vector2d point_m = a + motion.head<2>();
    const Target& partner = nearest(previous, point_m);
    const Eigen::Vector2d e = point_m - position(partner);
    const Eigen::Vector2d turned_a(-a.y(), a.x());
    const Eigen::Vector2d turned_e(-e.y(), e.x());
    hessian.topLeftCorner<2, 2>() += Eigen::Matrix2d::Identity();
    hessian.topRightCorner<2, 1>() += turned_a;
    hessian(2, 2) += a.squaredNorm() - e.dot(a);
    Eigen::Matrix<double, 3, 2> by_a;  // d2J / dx da
    by_a << Eigen::Matrix2d::Identity(), (turned_a - turned_e).transpose();
    Eigen::Matrix<double, 3, 2> by_q;  // d2J / dx dq
    by_q << -Eigen::Matrix2d::Identity(), -turned_a.transpose();
    spread +=
        by_a * rotation * covariance_matrix(target) * rotation.transpose() * by_a.transpose() +
        by_q * covariance_matrix(partner) * by_q.transpose();
  }
  hessian.bottomLeftCorner<1, 2>() = hessian.topRightCorner<2, 1>().transpose();
  const auto inverse = invert_information(hessian, 3);
  if (!inverse) {
    return std::nullopt;
  }
  return Eigen::Matrix3d(*inverse * spread * *inverse);
}

RegistrationResult register_icp(const TargetSet& previous, const TargetSet& current,
                                const RegistrationContext&) {
  RegistrationResult result;
  if (previous.size() == 0 || current.size() == 0) {
    result.status = RegistrationStatus::degenerate;
    return result;
  }
  const Eigen::Isometry2d motion =
      search(to_points(previous), to_points(current), result.iterations);
  result.motion << motion.translation(), yaw_of(motion);
  if (!result.motion.allFinite()) {
    return result;  // non_finite
  }
  const auto covariance = icp_covariance(previous, current, result.motion);
  if (!covariance) {
    result.status = RegistrationStatus::degenerate;
    return result;
  }
  result.covariance = *covariance;
  result.status = result.iterations < kMaxIterations ? RegistrationStatus::converged
                                                     : RegistrationStatus::no_convergence;
  return result;
}

}  // namespace cremed
