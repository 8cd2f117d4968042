// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/pairs/icp_covariance.hpp"

#include <algorithm>

#include "tools/eval/plane_motion.hpp"
#include "tools/laboratory/pairs/free_states.hpp"

namespace cremed {
namespace {

const Target& nearest(const TargetSet& targets, const Eigen::Vector2d& point_m) {
  return *std::min_element(targets.begin(), targets.end(), [&](const Target& a, const Target& b) {
    return (position(a) - point_m).squaredNorm() < (position(b) - point_m).squaredNorm();
  });
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
  const auto inverse = invert_free(hessian, 3);
  if (!inverse) {
    return std::nullopt;
  }
  return Eigen::Matrix3d(*inverse * spread * *inverse);
}

}  // namespace cremed
