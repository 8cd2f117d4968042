// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "estimator/ego_motion_estimator.hpp"
#include "estimator/innovation_mean.hpp"

namespace cremed {

/// More radars than any vehicle has.
inline constexpr std::size_t kMaxFusedRadars = 16;

/// Settings of the estimate from all radars together.
struct FusedOptions {
  bool enabled = true;  ///< Makes one where there are two radars or more.
  /// How a vehicle's velocity changes from the middle of one radar's interval to that of another's.
  double acceleration_std_mps2 = 1.5;
  double yaw_acceleration_std_radps2 = 0.2;
  /// Angle between the way a car rolls and the x axis of its frame, with two degrees of freedom:
  /// nobody measures a frame better than that. It is learned while driving.
  double side_slip_std_rad = 0.0075;
  double side_slip_walk_radps = 0.003;  ///< What it changes by in a second, as tyres do in a turn.
  /// A radar is left out of a fused motion if its normalised innovation squared, a degree of
  /// freedom, exceeds this; by chance one in 10 000 does.
  double max_innovation = 7.0;
};

/// What radars must agree on to be told apart from one that is wrong.
struct RadarAgreement {
  InnovationMean innovation;   ///< Of this radar against all others, of the last minute.
  bool contradicts = false;    ///< Left out until its innovation is small again.
  std::uint64_t used = 0;      ///< Motions that went into a fused estimate.
  std::uint64_t left_out = 0;  ///< Motions that contradicted the others.

  /// Decides by the innovation whether the radar contradicts.
  void judge();
  /// Those it contradicted were wrong: it begins anew.
  void forgive();
};

/// One ego-motion from all radars of a vehicle, whose scans need not come at the same times.
///
/// Each radar's motion (x, y, yaw) between two scans of its own, with y free whatever its degrees
/// of freedom, becomes a mean velocity (v_x, v_side, yaw rate) of its interval; v_side is what is
/// left of y without the arc, (y - x yaw / 2) / dt. It holds for the interval of the fused motion
/// but for what the vehicle accelerates between the two middles:
///
///     cov_j = P_j / dt_j^2 + (middle_j - middle)^2 diag(a^2, a^2, w^2)
///
/// The errors of different radars are independent but for the velocity of the body they are all
/// mounted on (SharedErrorOptions::velocity_std_mps), which is added after they are joined:
///
///     P^-1 = sum_j cov_j^-1
///
/// With two degrees of freedom v_side = slip v_x besides, with a slip angle that changes slowly:
/// what is known of it goes from one fused motion to the next. Errors of the mounting angles look
/// like slip and do not average out over time; they are added to the covariance of y.
///
/// A radar whose motions contradict the others and what the vehicle did before is left out, the
/// worst first; a radar that does so over a minute is left out altogether, but still compared. Of
/// two that contradict each other from the beginning nobody knows which is wrong: the fused motion
/// is ambiguous. Each motion is used once. A fused motion ends with each scan of the leading radar:
/// the first of those that are alive. Never allocates, throws or logs.
class FusedEstimator {
 public:
  /// `radars`: how many, and what they are set to. Degrees of freedom, velocity error and longest
  /// gap are those of the first.
  FusedEstimator(const FusedOptions& options, const EgoMotionOptions& first, std::size_t radars);

  /// Takes a motion of radar number `radar`; a fused one if that was the leading radar's. One that
  /// is not believed is compared with the others, but not used.
  std::optional<EgoMotion> update(std::size_t radar, const EgoMotion& motion,
                                  bool is_believed = true);

  /// The clock of the stamps was set: nothing before counts.
  void forget();

  [[nodiscard]] const RadarAgreement& agreement(std::size_t radar) const {
    return agreements_[radar];
  }

 private:
  static constexpr std::size_t kMaxMotions = 4 * kMaxFusedRadars;

  /// Mean velocity over an interval.
  struct Twist {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();  ///< (m/s forward, m/s sideways, rad/s)
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    double middle_s = 0.0;  ///< Since the end of the fused motion before.
  };
  /// One radar's since the fused motion before.
  struct Measurement {
    std::size_t radar = 0;
    Twist twist;
    /// Of the velocity in the fused motion's interval.
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    MotionStatus status = MotionStatus::ok;
    int targets = 0;
    bool is_believed = true;
    bool is_used = true;
  };
  /// Sums of information and information times mean.
  struct Sums {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
    void add(const Eigen::Matrix3d& more, const Eigen::Vector3d& mean);
  };

  struct Contradiction {
    bool is_any = false;
    bool is_plain = false;  ///< Which radar is wrong.
    std::size_t radar = 0;  ///< The likeliest.
    double worst = 0.0;     ///< Its score, and that of the next.
    double second = 0.0;
    void note(std::size_t which, double score);
  };

  bool leads(std::size_t radar, std::int64_t utime_us);
  void note(std::size_t radar, const EgoMotion& motion, bool is_believed);
  MotionStatus fuse(double dt_s, EgoMotion& fused);
  void weigh(double dt_s);
  [[nodiscard]] Sums prior() const;
  [[nodiscard]] Sums sum_of_used() const;
  [[nodiscard]] Sums known_before(double dt_s) const;
  [[nodiscard]] Sums own_sum(std::size_t radar) const;
  [[nodiscard]] Sums sum_of_others(std::size_t radar, Sums known) const;
  static std::optional<double> innovation(const Sums& own, const Sums& others);
  [[nodiscard]] Contradiction contradiction(const Sums& known) const;
  void leave_out(std::size_t radar);
  void note_agreement(const Sums& known);
  void learn_slip(double dt_s, const Twist& twist);
  void finish(double dt_s, const Twist& twist, EgoMotion& fused);
  [[nodiscard]] double velocity_mps() const;
  [[nodiscard]] std::size_t used() const;

  FusedOptions options_;
  EgoMotionOptions first_;
  std::array<RadarAgreement, kMaxFusedRadars> agreements_{};
  std::array<std::int64_t, kMaxFusedRadars> last_scan_us_{};
  std::array<Measurement, kMaxMotions> measurements_{};
  std::size_t count_ = 0;
  std::size_t radars_;
  std::size_t leader_;
  Twist last_;
  double slip_rad_ = 0.0;
  double slip_variance_rad2_;
  std::int64_t end_us_ = 0;  // Of the fused motion before.
  bool has_end_ = false;
  bool has_last_ = false;
};

}  // namespace cremed
