// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Whether a sensor hangs: it sends the targets of the previous scan again, while their Doppler
/// shows that the vehicle moves, or for ten scans in succession. A parked vehicle may see the same
/// twice: of 514 object lists of a standing ARS408 115 equal the previous one, of those with five
/// objects or more no two in succession. On healthy drives (6 of nuScenes and RadarScenes, 8000
/// scans) at most 75 % of a scan's targets equal those of the previous one, and that at rest.
class RepeatedTargets {
 public:
  void add(const TargetSet& targets);
  void forget() { *this = RepeatedTargets(); }
  [[nodiscard]] bool is_repeated() const { return is_repeated_; }

 private:
  /// Other targets have equal sums only by chance.
  struct Sums {
    std::size_t targets = 0;
    Eigen::Vector3d of = Eigen::Vector3d::Zero();  // Of x (m), y (m), Doppler (m/s).

    bool operator==(const Sums& other) const { return targets == other.targets && of == other.of; }
  };

  Sums last_;
  int repeats_ = 0;  // In succession.
  bool is_repeated_ = false;
};

}  // namespace cremed
