// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cremed/estimator/registration/registration.hpp"
#include "tools/laboratory/pairs/registration_pairs.hpp"

namespace cremed {

/// Pairs of scans with the options to register them.
struct BenchProblem {
  std::string name;
  RegistrationOptions options;
  std::vector<RegistrationPair> pairs;
};

/// PSR, PSR-C, Sim, Sim-C, and the latter two with Doppler (-D), always of the same landmarks.
std::vector<BenchProblem> simulated_problems(Likelihood likelihood);

/// Sim-D with this many targets in both scans, spread over the whole view, at the sensor's noise.
BenchProblem problem_of_size(std::size_t targets, Likelihood likelihood);

/// The worst case: full scans, 3 DoF, Doppler, all targets within each other's noise.
BenchProblem ambiguous_problem(Likelihood likelihood);

}  // namespace cremed
