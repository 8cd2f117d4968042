// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/registration/registration.hpp"
#include "tools/eval/credibility.hpp"
#include "tools/laboratory/pairs/registration_method.hpp"
#include "tools/laboratory/pairs/registration_pairs.hpp"

namespace cremed {

/// Processor time of this thread, independent of other programs.
double processor_us();

/// One pair's solution.
struct PairResult {
  RegistrationResult registration{};
  Eigen::Vector3d truth = Eigen::Vector3d::Zero();  ///< (x_m, y_m, yaw_rad).
  std::int64_t solve_us = 0;                        ///< Processor time.
};

/// Whether there is a motion with a covariance, converged or not.
bool has_solution(const RegistrationResult& result);

/// Solves a pair; motion and covariance are NaN without a solution.
PairResult solve_pair(const RegistrationPair& pair, const RegistrationOptions& options,
                      RegisterFunction method = register_msm);

/// Solves every pair on its own.
std::vector<PairResult> solve_pairs(const std::vector<RegistrationPair>& pairs,
                                    const RegistrationOptions& options,
                                    RegisterFunction method = register_msm);

/// Histogram of the normalised estimation error squared (NEES, not divided by the degrees of
/// freedom) with kBins bins; the last one includes everything above.
class NeesHistogram {
 public:
  static constexpr std::size_t kBins = 41;
  static constexpr double kBinWidth = 0.5;

  void add(double nees) {
    if (!std::isnan(nees)) {
      const double bin = std::clamp(nees / kBinWidth, 0.0, static_cast<double>(kBins - 1));
      ++counts_.at(static_cast<std::size_t>(bin));
    }
  }
  [[nodiscard]] const std::array<std::size_t, kBins>& counts() const { return counts_; }

 private:
  std::array<std::size_t, kBins> counts_{};
};

/// A consistent estimate of 3 (2) DoF exceeds it with probability 2e-5 (4e-6).
inline constexpr double kGrossNees = 25.0;

/// Figures of many pairs.
struct PairsFigures {
  Credibility credibility{3};      ///< Of the solutions.
  double iterations = 0.0;         ///< Mean per pair.
  double solve_us = 0.0;           ///< Mean per pair, of one processor.
  std::size_t left_out = 0;        ///< Pairs without a solution (degenerate, not finite).
  std::size_t ambiguous = 0;       ///< Of these, pairs where another motion fits as well.
  std::size_t no_convergence = 0;  ///< Pairs whose search did not converge, with a solution or not.
  std::size_t gross = 0;           ///< Solutions with NEES > kGrossNees.
  NeesHistogram nees{};
};

/// Compares the solutions with truth.
PairsFigures pairs_figures(const std::vector<PairResult>& results, int degrees_of_freedom);

/// The targets of a scan in the vehicle frame.
TargetSet to_targets(const std::vector<Detection>& detections, const Pose2& vehicle_from_radar);

}  // namespace cremed
