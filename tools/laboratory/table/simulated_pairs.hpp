// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "tools/laboratory/pairs/registration_pairs.hpp"
#include "tools/simulate/random.hpp"

namespace cremed {

/// The paper's simulated problems: point set registration (all around, 3 DoF) and a radar with its
/// field of view (2 DoF); _c: with clusters of landmarks.
enum class SimulatedProblem : std::uint8_t { psr, psr_c, sim, sim_c };
inline constexpr std::array kSimulatedProblems{SimulatedProblem::psr, SimulatedProblem::psr_c,
                                               SimulatedProblem::sim, SimulatedProblem::sim_c};

/// Standard deviations of a target's measurement.
struct DetectionNoise {
  double range_m;
  double azimuth_rad;
  double doppler_mps;
};

/// Parameters of a simulated problem.
struct SimulatedProblemSettings {
  std::string_view name;     ///< As the paper calls it.
  std::string_view profile;  ///< Name for profile().
  int degrees_of_freedom;    ///< 2: the vehicle moves along x only.
  double min_range_m;        ///< Of the landmarks, uniform.
  double max_range_m;
  double half_spread_rad;  ///< Landmarks stand within +- this azimuth, uniform.
  double half_view_rad;    ///< The radar sees targets whose true azimuth is within +- this.
  DetectionNoise noise;
  std::size_t clusters;  ///< This many landmarks have two more beside them.
  std::size_t sets;      ///< Sets of landmarks in the paper's evaluation,
  std::size_t runs;      ///< and runs (motion and noise) with each.
};

const SimulatedProblemSettings& settings(SimulatedProblem problem);

/// The static target at `point_m` in the radar's frame, seen while the radar moves with (vx, vy).
Detection observe(const Eigen::Vector2d& point_m, const Eigen::Vector2d& velocity_mps,
                  const DetectionNoise& noise, Random& random);

/// One pair: the landmarks depend on (problem, seed, set), motion and noise also on `run`.
/// Detection::id is the landmark's number, so equal ids correspond.
RegistrationPair simulated_pair(SimulatedProblem problem, std::uint64_t seed, std::size_t set,
                                std::size_t run);

/// `runs` pairs of each of `sets` sets of landmarks, in the order of the sets.
std::vector<RegistrationPair> simulated_pairs(SimulatedProblem problem, std::uint64_t seed,
                                              std::size_t sets, std::size_t runs);

}  // namespace cremed
