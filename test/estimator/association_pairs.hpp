// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/cost/association.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed::simulation {

using Ratios = Eigen::MatrixXd;                  // 0: no such pair
using Gradients = std::vector<Eigen::Vector3d>;  // of each pair, row by row

/// The pairs whose ratios are not 0; without `gradients` these are 0.
void fill(Association& association, const Ratios& ratios, const Gradients& gradients = {});

/// Ratios 10^-decades .. 10^decades.
Ratios random_ratios(Random& random, Eigen::Index rows, Eigen::Index columns, double decades);

std::unique_ptr<Association> make_association();

}  // namespace cremed::simulation
