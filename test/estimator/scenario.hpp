// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "cremed/estimator/registration/registration_options.hpp"
#include "cremed/estimator/registration/registration_result.hpp"
#include "cremed/estimator/scan/pose2.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed::simulation {

using numeric::radians;

/// A simulated problem of the paper, with optional extensions.
struct Scenario {
  RegistrationOptions options = paper_options();
  Noise noise;
  double min_range_m = 2.5;
  double max_range_m = 37.5;
  double half_spread_rad = radians(55.0);
  double half_view_rad = radians(40.0);
  double max_yaw_rad = radians(15.0);
  double clutter = 0.0;      ///< Share of each scan without a partner.
  double movers = 0.0;       ///< Share of the landmarks that move on their own.
  std::size_t clusters = 0;  ///< Landmarks that have two more beside them.
};

void keep_visible(Detections& detections, double half_view_rad);

void add_clutter(Detections& detections, const Scenario& scenario, Random& random);

/// Moves the first landmarks, which changes position and Doppler.
void move_landmarks(Detections& current, double share, Random& random);

/// 20 landmarks, some of them with two more each beside them.
Points landmarks(const Scenario& scenario, Random& random);

/// What a registration by itself tells of two scans.
RegistrationResult solve(const RegistrationOptions& options, const Detections& previous,
                         const Detections& current, double dt_s = kDt, const Pose2& mount = {});

struct Run {
  Eigen::Vector3d error;
  RegistrationResult result;
};

Run run(const Scenario& scenario, Random& random);

Scenario without_doppler();

/// Point set registration: all around, three states, no outlier model, one stage.
Scenario point_set();

}  // namespace cremed::simulation
