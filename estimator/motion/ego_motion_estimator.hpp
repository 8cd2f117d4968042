// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include <Eigen/Core>

#include "cremed/can_decoders/radar_scan.hpp"
#include "cremed/estimator/doubt/scan/two_worlds.hpp"
#include "cremed/estimator/motion/ego_motion_options.hpp"
#include "cremed/estimator/registration/predicted_motion.hpp"
#include "cremed/estimator/registration/registration.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Whether an EgoMotion holds an estimate, or why not. The numbers are those of ego_motion_t and
/// never change meaning.
enum class MotionStatus : std::uint8_t {
  ok = 0,               ///< An estimate.
  standing_still = 1,   ///< An estimate; speed, and sigma of x and y over dt, <= standstill_mps,
                        ///< |yaw| <= 3 sigma, median |Doppler| / sigma <= 1.
  no_reference = 2,     ///< The first usable scan.
  incomplete_scan = 3,  ///< The scan contradicts itself or is over capacity (RadarScan::status), or
                        ///< its stamp is wrong.
  gap_too_long = 4,     ///< Time since the reference scan > max_gap_s, or not > 0.
  too_few_targets = 5,  ///< Usable targets < min_targets.
  degenerate = 6,       ///< J'J not positive definite, or a sigma > max_std_m, max_std_rad.
  no_convergence = 7,   ///< A limit on iterations or work was reached.
  non_finite = 8,       ///< A number of the scan is NaN, infinite, or a sigma not > 0.
  implausible = 9,      ///< Speed > max_speed_mps or turn > max_yaw_rate_radps.
  ambiguous = 10,       ///< RegistrationStatus::ambiguous, of a motion that does not continue the
                        ///< one before; two worlds (doubt/scan/two_worlds.hpp); or the odometry
                        ///< contradicts it (doubt/vehicle/motion_witness.hpp).
};
inline constexpr std::size_t kMotionStatusCount = 11;

/// The name of a status as in the CSV, e.g. "ok".
std::string_view to_string(MotionStatus status);

/// Ego-motion between two scans of one radar: pose of the vehicle at `utime_us` in its frame at
/// `utime_start_us`, order (x_m, y_m, yaw_rad), covariance in the same order. NaN unless
/// has_estimate().
struct EgoMotion {
  std::int64_t utime_start_us = 0;
  std::int64_t utime_us = 0;
  MotionStatus status = MotionStatus::no_reference;
  Eigen::Vector3d motion = Eigen::Vector3d::Constant(kNan);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Constant(kNan);
  bool incomplete = false;    ///< Parts of the current scan are missing.
  int targets = 0;            ///< Usable targets in the current scan.
  int iterations = 0;         ///< Gauss-Newton steps.
  double doppler_nis = kNan;  ///< See RegistrationResult.
  YawByPositions by_positions;

  static constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  [[nodiscard]] bool has_estimate() const {
    return status == MotionStatus::ok || status == MotionStatus::standing_still;
  }
};

/// Estimates the motion between successive scans of one radar. An unusable scan (contradictory, too
/// few targets, not finite) is skipped: the next estimate then starts at the last usable scan, up
/// to max_gap_s before. Never allocates, throws or logs.
class EgoMotionEstimator {
 public:
  explicit EgoMotionEstimator(const EgoMotionOptions& options);

  EgoMotion update(const RadarScan& scan);
  /// For a scan whose stamp is wrong: incomplete_scan.
  EgoMotion reject(const RadarScan& scan);

  /// To be called when the clock of the stamps was set: the next scan has no reference.
  void forget_reference();
  /// Multiplies the Doppler of targets() and of all further scans by a factor that was learned
  /// while driving (OdometryFilter::take_doppler_factor()). The next scan has no reference.
  void correct_doppler(double factor);

  /// The usable targets of the last scan, whatever its status; none with incomplete_scan.
  [[nodiscard]] const TargetSet& targets() const { return targets_; }
  [[nodiscard]] const SelectionCounters& selection() const { return selection_; }

 private:
  [[nodiscard]] EgoMotion begin(const RadarScan& scan) const;
  MotionStatus select_targets(const RadarScan& scan);
  MotionStatus solve(double dt_s, EgoMotion& motion);
  MotionStatus judge(const RegistrationResult& result, double dt_s);
  [[nodiscard]] std::optional<PredictedMotion> predict(double doppler_mps, double dt_s) const;
  [[nodiscard]] ContinuedMotion continued(double dt_s) const;
  [[nodiscard]] bool continues(const RegistrationResult& result, double dt_s) const;
  bool is_standing(const RegistrationResult& result, double dt_s);
  double median_normalised_doppler();
  double doppler_speed_mps();
  bool sees_two_worlds(const RegistrationResult& result, double dt_s);

  EgoMotionOptions options_;
  Registration registration_;
  TwoWorlds two_worlds_;
  TargetSet targets_;
  SelectionCounters selection_;
  std::array<double, kMaxDetections> scratch_{};
  Eigen::Vector3d last_velocity_ = Eigen::Vector3d::Zero();  // (m/s, m/s, rad/s)
  std::int64_t reference_stamp_us_ = 0;
  bool has_reference_ = false;
  bool has_velocity_ = false;  // last_velocity_ is of the previous scan
  bool has_started_ = false;   // there was an estimate after the last gap
};

}  // namespace cremed
