// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/fusion/state/odometry_state.hpp"
#include "cremed/estimator/motion/doppler_velocity.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Whether a vehicle that stood for a while has started, or what it sees: a train, a convoy, a jam.
/// By Doppler both are the same but for what remains at rest, so it has started if
///
/// - no radar sees more than a few targets at rest while the others depart,
/// - all radars see the same speed along x,
/// - and none sees it move sideways more than in the tightest turn.
///
/// Otherwise it is in doubt as long as something departs.
class ParkedVehicle {
 public:
  enum class Verdict : std::uint8_t { rests, in_doubt, started };

  /// Uses the mounts of `state`, which must outlive this object.
  explicit ParkedVehicle(const OdometryState& state);

  void clear();
  /// The odometry stands still, or not, at this time.
  void add_status(std::int64_t utime_us, bool is_standing);
  [[nodiscard]] bool is_at_rest() const { return is_parked_ || is_standing_; }
  /// It stood for kParkedUs, and has not started since.
  [[nodiscard]] bool is_parked() const { return is_parked_; }
  /// Judges by a scan, and by the last ones of the other radars. Not parked if started.
  Verdict judge(std::size_t radar, const TargetSet& targets, const DopplerVelocity& velocity,
                std::int64_t stamp_us);

 private:
  static constexpr std::int64_t kParkedUs = 1'000'000;

  /// Of the last scans of a radar, sums with weights that decay.
  struct Look {
    std::int64_t stamp_us = 0;
    double scans = 0.0;
    double targets = 0.0;
    Eigen::Vector2d sum_mps = Eigen::Vector2d::Zero();
    Eigen::Vector2d sum_variance = Eigen::Vector2d::Zero();
    double sure_votes = 0.0;   ///< Targets whose Doppler tells rest from the velocity in each scan,
    double rest_places = 0.0;  ///< and places of those at rest.
    double votes = 0.0;  ///< Targets whose Doppler tells rest from the velocity. Sums of squares:
    double expected = 0.0;  ///< of their Doppler by the velocity,
    double missed = 0.0;    ///< of what they miss of it, at most all,
    double noise = 0.0;     ///< and of what of this is noise.

    [[nodiscard]] Eigen::Vector2d mean_mps() const { return sum_mps / scans; }
    [[nodiscard]] Eigen::Vector2d variance() const { return sum_variance / (scans * scans); }
    void decay(double dt_s);
    void add(const TargetSet& seen, const DopplerVelocity& velocity, double doppler_variance);
    void add(const Look& other);
    [[nodiscard]] bool departs() const;
    [[nodiscard]] bool has_votes() const;
    [[nodiscard]] bool has_few_rest_places() const;
    /// Share of the votes that is at rest, and so many standard deviations.
    [[nodiscard]] double rest_share(double sigmas) const;
  };

  [[nodiscard]] Verdict verdict(std::int64_t stamp_us) const;
  [[nodiscard]] bool is_along(std::size_t radar) const;

  const OdometryState& state_;
  std::vector<Look> looks_;
  std::vector<double> doppler_variances_;  // Of a target, learned at rest.
  bool is_parked_ = false;
  bool is_standing_ = false;
  std::int64_t standing_us_ = 0;  // Since when.
};

}  // namespace cremed
