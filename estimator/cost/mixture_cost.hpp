// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include <Eigen/Core>

#include "cremed/estimator/cost/cost_options.hpp"
#include "cremed/estimator/cost/mixture.hpp"
#include "cremed/estimator/cost/normal_equations.hpp"
#include "cremed/estimator/cost/outlier_ray.hpp"
#include "cremed/estimator/cost/yaw_by_positions.hpp"
#include "cremed/estimator/scan/pose2.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// The paper's cost (RA-L 2022), (1) and (2) of the README: each current target against the
/// Max-Sum-Mixture of the previous scan, and its Doppler as a max mixture of a static and a moving
/// target. Its covariance is (J'J)^-1. All storage is inside the object.
class MixtureCost {
 public:
  MixtureCost(int degrees_of_freedom, const DopplerOptions& doppler,
              const Pose2& vehicle_from_radar);

  /// Sets the previous scan, at least one target.
  void set_previous(const TargetSet& targets, const OutlierRay& ray) {
    mixture_.assign(targets, ray);
  }
  /// Sets the current scan, which must outlive the calls of linearise().
  void set_current(const TargetSet& current, double dt_s);
  /// Factors on the standard deviations of the current scan's positions and Doppler.
  void set_scales(double positions, double doppler);

  NormalEquations linearise(const Unknowns& at);
  static constexpr bool kHasStepControl = true;
  [[nodiscard]] static constexpr bool is_complete() { return true; }
  [[nodiscard]] static constexpr bool is_settled() { return true; }
  static constexpr void settle() {}
  [[nodiscard]] std::int64_t evaluations() const { return evaluations_; }

  static constexpr void start() {}
  /// The first stage ends at a step whose squared length in standard deviations is smaller than
  /// this. It only provides the start of the second.
  static constexpr double kStartTolerance = 1e-2;
  /// A search ends at a step whose squared length in standard deviations (step' J'J step) is
  /// smaller than this.
  static constexpr double kStepTolerance = 1e-5;
  [[nodiscard]] std::optional<Estimate> estimate(const Unknowns& at,
                                                 const NormalEquations& equations) const;
  /// Not available with this likelihood.
  [[nodiscard]] static constexpr double matched() { return 0.0; }
  [[nodiscard]] static constexpr double doppler_nis() {
    return std::numeric_limits<double>::quiet_NaN();
  }
  [[nodiscard]] static YawByPositions by_positions(const Unknowns& /*at*/) { return {}; }

 private:
  void add_positions(const Eigen::Vector3d& motion, NormalEquations& equations);
  void add_doppler(const Eigen::Vector3d& motion, NormalEquations& equations) const;

  int degrees_of_freedom_;
  DopplerOptions doppler_;
  Pose2 vehicle_from_radar_;
  Mixture mixture_;
  const TargetSet* current_ = nullptr;
  double dt_s_ = 0.0;
  double scale_ = 1.0;
  double doppler_scale_ = 1.0;
  std::int64_t evaluations_ = 0;
};

}  // namespace cremed
