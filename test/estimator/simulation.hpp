// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "cremed/can_decoders/radar_scan.hpp"
#include "cremed/estimator/cost/mixture_cost.hpp"
#include "cremed/estimator/registration/registration_options.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed::simulation {

using Random = std::mt19937_64;
using Points = std::vector<Eigen::Vector2d>;
using Detections = std::vector<Detection>;

/// Period of a radar.
inline constexpr double kPeriodS = 0.075;
/// Times in s between the two scans of a pair.
inline constexpr double kDt = 0.2;
inline constexpr double kShortDt = 0.1;

inline constexpr Pose2 kFront{3.4, 0.0, 0.0};
inline constexpr Pose2 kRearLeft{-0.6, 0.6, 3.05};
inline constexpr Pose2 kRearRight{-0.6, -0.6, -3.05};
/// One ahead and one to the left, in which nothing is zero.
inline const std::vector<Pose2> kTwoMounts{{3.4, 0.1, 0.02}, {2.4, 0.8, 1.54}};

inline constexpr std::array kModels = {Likelihood::exclusive, Likelihood::max_sum_mixture};
inline const Eigen::Vector3d kStill = Eigen::Vector3d::Zero();

struct Noise {
  double range_m = 0.13;
  double azimuth_rad = 0.0157;
  double doppler_mps = 0.3;
};

double uniform(Random& random, double low, double high);

/// Point of the frame in which `pose` = (x, y, yaw) is given, as seen from that pose.
Eigen::Vector2d seen_from(const Eigen::Vector3d& pose, const Eigen::Vector2d& point);

Eigen::Vector3d as_vector(const Pose2& pose);

/// The inverse of a motion.
Eigen::Vector3d inverse(const Eigen::Vector3d& motion);

/// Detection of a static point of the vehicle frame by an ideal radar, while the vehicle moves with
/// `velocity` = (m/s forward, m/s left, rad/s) in its own frame.
Detection observe(const Eigen::Vector2d& point, const Eigen::Vector3d& velocity, const Pose2& mount,
                  const Noise& noise);

/// All points as seen after `motion`, of duration `dt_s` at constant speed.
Detections observe_all(const Points& points, const Eigen::Vector3d& motion, double dt_s,
                       const Pose2& mount, const Noise& noise);

/// All points as seen after `motion` by a radar at the vehicle's origin.
Detections see(const Points& points, const Eigen::Vector3d& motion);

/// With isotropic noise: covariances then do not depend on yaw.
Detections isotropic(Detections detections, double std_m);

/// Adds noise with the detection's standard deviations.
void perturb(Detections& detections, Random& random);

TargetSet targets(const Detections& detections, const Pose2& mount);

RadarScan scan(const Detections& detections, std::int64_t stamp_us);

/// Points around the vehicle, at least `spacing_m` apart, as a radar with the given field of view
/// at the vehicle's origin sees them.
Points scatter(Random& random, std::size_t count, double min_range_m, double max_range_m,
               double half_view_rad, double spacing_m);

/// No systematic errors: the noise of targets is independent.
SharedErrorOptions no_shared_errors();

/// Settings with which the paper's simulated problem is solved (Doppler of the current scan, 2
/// DoF).
RegistrationOptions paper_options();

RegistrationOptions paper_options(int degrees_of_freedom, bool has_doppler,
                                  Likelihood model = Likelihood::exclusive);

/// The paper's cost of two scans, with the standard deviations of the current scan times `scale`.
std::unique_ptr<MixtureCost> mixture_cost(const RegistrationOptions& options, const Pose2& mount,
                                          const TargetSet& previous, const TargetSet& current,
                                          double dt_s, double scale = 1.0);

}  // namespace cremed::simulation
