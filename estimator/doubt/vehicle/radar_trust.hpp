// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "cremed/estimator/doubt/radar/nis_mean.hpp"
#include "cremed/estimator/motion/doppler_velocity.hpp"

namespace cremed {

/// Factor on the covariance of a radar's measurements that keeps its time-averaged NIS at 1 or
/// below. It accounts for unmodelled errors, for example with few targets. Its time constant is 20
/// measurements.
class NoiseFactor {
 public:
  [[nodiscard]] double value() const { return value_; }
  /// `nis`: per degree of freedom, with the factor applied.
  void add(double nis);
  void clear() { value_ = 1.0; }

 private:
  /// Five times the stated standard deviations. Beyond, a radar is left out.
  static constexpr double kMaxFactor = 25.0;

  double value_ = 1.0;
};

/// Time for which the verdict on a radar's scan, or a doubt, is valid: four scans of an ARS408, in
/// which a braking vehicle changes its speed by 3 m/s.
inline constexpr double kScanVerdictValidS = 0.3;

/// How much a radar is trusted.
struct RadarTrust {
  /// Contradicting minus agreeing scans at which a radar that looks sideways is left out
  /// (FaultHypotheses judges the others): 0.4 s of an ARS408.
  static constexpr int kMaxContradictions = 5;
  /// Left out for this time, its learned errors are doubted: a passing vehicle takes 2 s at most.
  static constexpr double kDoubtedS = 2.4;
  /// Left out for this time, it is at fault.
  static constexpr double kFaultyS = 3.0;

  NisMean doppler;  ///< NIS of the last minute.
  NisMean lateral;
  NisMean yaw;
  NoiseFactor doppler_noise;
  NoiseFactor position_noise;
  int contradictions = 0;
  bool is_left_out = false;
  std::int64_t left_out_us = 0;  ///< Since when.
  bool is_doubted = false;       ///< It was left out for kDoubtedS or longer.
  bool is_trusted = true;        ///< By its self-check: it may vote.
  // Its last scan:
  bool has_verdict = false;
  bool agrees = false;
  bool contradicts_positions = false;  ///< By Doppler; the state agrees with them.
  std::int64_t verdict_us = 0;
  DopplerVelocity velocity;

  /// Whether its last scan counts: the radar is trusted and the scan not older than
  /// kScanVerdictValidS.
  [[nodiscard]] bool votes(std::int64_t time_us) const;
  /// Whether its last scan agreed, at any age.
  [[nodiscard]] bool has_agreed() const { return has_verdict && agrees; }
  /// Records whether a scan's velocity is as the filter expects. True if from now on what was
  /// learned of the radar is doubted.
  bool judge(std::int64_t stamp_us, const DopplerVelocity& measured, bool is_expected);
  /// Clears its contradictions: the filter was wrong.
  void forgive();
};

}  // namespace cremed
