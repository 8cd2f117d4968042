// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/fusion/map/target_map.hpp"
#include "cremed/estimator/scan/symmetric2.hpp"

namespace cremed {

/// Sums over the pairs of one target of a scan, each weighted with its density w.
struct PairSums {
  double weight = 0.0;
  Symmetric2 information;                           ///< w C^-1
  Eigen::Vector2d force = Eigen::Vector2d::Zero();  ///< w f, f = C^-1 e
  Symmetric2 squared_force;                         ///< w f f'
};

/// Pairs of a target of a scan and one of the map that may be the same, target after target. One
/// column for each quantity, so that several pairs are evaluated at once; each target's pairs are
/// filled up to a multiple of kLanes with pairs of density 0.
class MapPairs {
 public:
  static constexpr std::size_t kLanes = 4;
  /// Bounds the work; targets beyond have no partner. RadarScenes, with 200 targets a scan, has up
  /// to 10 000.
  static constexpr std::size_t kMaxPairs = 32768;

  MapPairs();

  void clear() { size_ = 0; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool is_full() const { return size_ == kMaxPairs; }
  /// `density`: N(0; C), `information`: C^-1 of the pair.
  void add(const TargetMap::Placed& placed, const Symmetric2& information, double density);
  /// Ends the pairs of a target.
  void pad();

  /// Sums over the pairs from `begin` to `end`, multiples of kLanes, if the scan's target is at
  /// `at_m`. Keeps the density of each.
  PairSums sum_up(std::size_t begin, std::size_t end, const Eigen::Vector2d& at_m);

  /// N(e; C) at the last sum; 0 beyond 5 sigma.
  [[nodiscard]] double weight(std::size_t k) const { return weight_[k]; }
  [[nodiscard]] Eigen::Vector2d at_m(std::size_t k) const { return {x_m_[k], y_m_[k]}; }
  [[nodiscard]] Symmetric2 information(std::size_t k) const { return {xx_[k], xy_[k], yy_[k]}; }
  [[nodiscard]] std::uint8_t node(std::size_t k) const { return node_[k]; }
  /// Azimuth of the map's target in the radar's frame when it was measured.
  [[nodiscard]] double azimuth_rad(std::size_t k) const { return azimuth_rad_[k]; }

 private:
  template <typename Pack>
  PairSums sum_up_packs(std::size_t begin, std::size_t end, const Eigen::Vector2d& at_m);
  PairSums sum_up_plain(std::size_t begin, std::size_t end, const Eigen::Vector2d& at_m);
  PairSums sum_up_avx2(std::size_t begin, std::size_t end, const Eigen::Vector2d& at_m);

  std::size_t size_ = 0;
  // Allocated once, for kMaxPairs. Of the map's target:
  std::vector<double> x_m_;
  std::vector<double> y_m_;
  std::vector<double> azimuth_rad_;
  std::vector<std::uint8_t> node_;
  // Of the pair:
  std::vector<double> xx_;
  std::vector<double> xy_;
  std::vector<double> yy_;
  std::vector<double> density_;
  std::vector<double> weight_;
};

}  // namespace cremed
