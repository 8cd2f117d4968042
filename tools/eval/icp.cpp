// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/icp.hpp"

#include <cmath>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/transformation_estimation_2D.h>

#include "tools/eval/icp_covariance.hpp"

namespace cremed {
namespace {

constexpr int kMaxIterations = 50;         // the paper's
constexpr double kStepTolerance2 = 1e-12;  // squared, m and rad

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Icp = pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ, double>;

Cloud::Ptr to_cloud(const TargetSet& targets) {
  Cloud::Ptr cloud(new Cloud);
  for (const Target& target : targets) {
    cloud->emplace_back(static_cast<float>(target.x_m), static_cast<float>(target.y_m), 0.0F);
  }
  return cloud;
}

/// Makes the count of steps, which PCL keeps to itself, readable.
class CountingIcp : public Icp {
 public:
  [[nodiscard]] int iterations() const { return nr_iterations_; }
};

Eigen::Vector3d plane_motion(const Eigen::Matrix4d& transform) {
  return {transform(0, 3), transform(1, 3), std::atan2(transform(1, 0), transform(0, 0))};
}

}  // namespace

const bool kHasIcp = true;

RegistrationResult register_icp(const TargetSet& previous, const TargetSet& current,
                                const RegistrationContext&) {
  CountingIcp icp;
  icp.setInputSource(to_cloud(current));
  icp.setInputTarget(to_cloud(previous));
  icp.setMaximumIterations(kMaxIterations);
  icp.setTransformationEpsilon(kStepTolerance2);
  icp.setTransformationRotationEpsilon(1.0 - kStepTolerance2);
  icp.setTransformationEstimation(Icp::TransformationEstimationPtr(
      new pcl::registration::TransformationEstimation2D<pcl::PointXYZ, pcl::PointXYZ, double>()));
  Cloud moved;
  icp.align(moved);

  RegistrationResult result;
  result.motion = plane_motion(icp.getFinalTransformation());
  result.iterations = icp.iterations();
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
