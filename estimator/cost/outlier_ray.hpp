// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "cremed/estimator/cost/cost_options.hpp"
#include "cremed/estimator/scan/pose2.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// a: standard deviation over range of a component. b: range of a component over that of the
/// previous one. Source: the paper (RA-L 2022), all tables.
inline constexpr double kRayRatio = 0.7;
inline constexpr double kRayGrowth = 1.8;
/// A ray from 1 cm to 1 km needs 18.
inline constexpr std::size_t kMaxRayComponents = 32;

/// One Gaussian of the outlier model, in the vehicle frame.
struct RayComponent {
  double x_m = 0.0;
  double y_m = 0.0;
  Symmetric2 covariance_m2;
  double weight = 0.0;
};

/// The outlier model: Gaussians along the radar's axis that together cover its field of view out to
/// r_max (Sola 2007, section 3.2: rho_1 = r_min / (1 - a), rho_k = b rho_{k-1}, std_k = a rho_k).
/// Their weights add up to `options.weight`; there is no component if that is 0. Components beyond
/// kMaxRayComponents are left out at the far end.
class OutlierRay {
 public:
  OutlierRay(const OutlierRayOptions& options, const Pose2& vehicle_from_radar);

  [[nodiscard]] const RayComponent* begin() const { return components_.data(); }
  [[nodiscard]] const RayComponent* end() const { return components_.data() + size_; }
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Total weight, w_o.
  [[nodiscard]] double weight() const { return weight_; }

 private:
  std::array<RayComponent, kMaxRayComponents> components_{};
  std::size_t size_ = 0;
  double weight_ = 0.0;
};

/// N = 1 + ceil(log((1 - a) / (1 + a) r_max / r_min) / log b), at least 1, at most
/// kMaxRayComponents.
std::size_t ray_component_count(const OutlierRayOptions& options);

}  // namespace cremed
