// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Corrects the Doppler of all radars by a factor that was learned while driving, because they
/// share an error of scale (FaultHypotheses::common_scale()).
class DopplerCorrection {
 public:
  /// A further factor with which Doppler agrees with positions. What is near 1 is left to the
  /// filter, which estimates it.
  void learn(double factor) {
    factor_ *= factor;
    factor_ = std::abs(factor_ - 1.0) < kMinShare ? 1.0 : factor_;
  }

  [[nodiscard]] double factor() const { return factor_; }
  [[nodiscard]] bool is_learned() const { return factor_ != 1.0; }
  /// Valid until the next call.
  [[nodiscard]] const TargetSet& corrected(const TargetSet& targets);

 private:
  /// The sigma that is left to the filter.
  static constexpr double kMinShare = 0.02;

  double factor_ = 1.0;
  TargetSet corrected_;
};

}  // namespace cremed
