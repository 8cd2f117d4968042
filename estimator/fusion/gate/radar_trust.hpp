// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "cremed/estimator/motion/doppler_velocity.hpp"
#include "cremed/estimator/motion/innovation_mean.hpp"

namespace cremed {

/// Factor on the covariance of a radar's measurements that keeps its time-averaged NIS from
/// exceeding 1: errors nobody stated, as where few targets are seen. It follows within some 20
/// measurements.
class NoiseFactor {
 public:
  [[nodiscard]] double value() const { return value_; }
  /// `innovation`: normalised, squared, a degree of freedom, with the factor applied.
  void add(double innovation);
  void clear() { value_ = 1.0; }

 private:
  /// Five times the stated deviations: beyond, a radar is left out rather than widened.
  static constexpr double kMaxFactor = 25.0;

  double value_ = 1.0;
};

/// How long the verdict on a radar's scan, or a doubt, counts: four scans of an ARS408, in which a
/// braking vehicle changes its speed by 3 m/s.
inline constexpr double kVerdictS = 0.3;

/// How far a radar is believed.
struct RadarTrust {
  /// Scans in succession, of which those that agree are taken off again, until it is left out: 0.4
  /// s of an ARS408. By chance a scan contradicts once in 3000 (max_doppler_nis).
  static constexpr int kMaxContradictions = 5;

  InnovationMean doppler;  ///< Of the last minute.
  InnovationMean lateral;
  InnovationMean yaw;
  NoiseFactor doppler_noise;
  NoiseFactor position_noise;
  int contradictions = 0;
  bool is_left_out = false;
  bool is_believed = true;  ///< By its self-check: it has a say.
  // Its last scan:
  bool has_verdict = false;
  bool agrees = false;
  std::int64_t verdict_us = 0;
  DopplerVelocity velocity;

  /// Whether its last scan counts: of a radar that is believed, not longer ago than kVerdictS.
  [[nodiscard]] bool votes(std::int64_t time_us) const;
  /// Whether its last scan did, however long ago.
  [[nodiscard]] bool has_agreed() const { return has_verdict && agrees; }
  /// Whether a scan's velocity is where the filter expects it.
  void judge(std::int64_t stamp_us, const DopplerVelocity& measured, bool is_expected);
  /// What it contradicted was wrong.
  void forgive();
};

}  // namespace cremed
