// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <optional>

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
  /// What is left of a factor by a radar's own check; none if that is near 1.
  [[nodiscard]] std::optional<double> left_of(std::optional<double> factor) const {
    const double left = factor.value_or(factor_) / factor_;
    return std::abs(left - 1.0) > kOwnCheckShare ? std::optional(left) : std::nullopt;
  }
  /// Valid until the next call.
  [[nodiscard]] const TargetSet& corrected(const TargetSet& targets);

 private:
  /// The sigma that is left to the filter.
  static constexpr double kMinShare = 0.02;

  /// By which healthy radars differ from their positions (DopplerScale).
  static constexpr double kOwnCheckShare = 0.03;

  double factor_ = 1.0;
  TargetSet corrected_;
};

}  // namespace cremed
