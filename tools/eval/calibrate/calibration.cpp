// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/calibrate/calibration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

#include <Eigen/Dense>

#include "cremed/estimator/scan/median.hpp"
#include "daemon/process/message_text.hpp"
#include "tools/eval/calibrate/matched_turns.hpp"
#include "tools/eval/drive/missing_time.hpp"
#include "tools/eval/recorded_drive.hpp"

namespace cremed {
namespace {

/// Prior standard deviations of a radar, in the order of CalibrationState.
constexpr CalibrationVector kPriorStd = {0.35, 0.3,  0.3,  0.1, 0.03, 0.01,
                                         0.05, 0.05, 0.02, 0.0, 0.03, 0.0};
/// With a larger standard deviation the configured value is kept: a tape measure is as good.
constexpr CalibrationVector kWorstStd = {0.0175, 0.03, 0.03, 0.05, 0.007, 0.002, 0.005, 0.0, 0.006};
/// States that are reported; the others are nuisance parameters or checks.
constexpr std::array kTold = {kYaw, kX, kY, kOffset, kStamp, kScale, kLead, kAzimuth};
/// Priors of the rolling direction and the slip of the rear axle: 0.005 rad s^2/m is 800 kg on
/// tyres with a cornering stiffness of 160 kN/rad.
constexpr std::array<double, kRollingStates> kVehiclePriorStd = {0.05, 0.005};
constexpr double kWorstSlipStd = 0.001;  // rad s^2/m: a third of a car's slip.
/// Errors of a scan's velocity that all its targets share: four nuScenes drives, front and rear
/// radars.
constexpr double kSharedVelocityStdMps = 0.04;
constexpr double kSignificant = 3.0;  // Standard deviations.
constexpr int kRounds = 3;
// Afterwards the mounts are accurate enough that registrations no longer change.
constexpr int kRegisteredRounds = 2;
constexpr double kSlowestMps = 0.5;              // At lower speeds Doppler gives no direction.
constexpr double kLeastYawRateStdRadps = 0.002;  // At standstill.

CalibrationVector configured(const RadarConfiguration& radar) {
  const Pose2& mount = radar.ego_motion.vehicle_from_radar;
  CalibrationVector state{};
  state[kYaw] = mount.yaw_rad;
  state[kX] = mount.x_m;
  state[kY] = mount.y_m;
  return state;
}

double wrapped(double angle_rad) { return std::remainder(angle_rad, 2.0 * std::numbers::pi); }

/// The direction in which the radar moves, from the x axis of the vehicle by this yaw of its mount;
/// nothing if it hardly moves. Most of a drive is straight: the median over the scans, about the
/// mean so that no direction is cut in two.
std::optional<double> direction_rad(const RecordedRadar& recorded, double mount_yaw_rad) {
  std::vector<double> directions_rad;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const RecordedScan& scan : recorded.scans) {
    const auto state = agreed_velocity(scan.targets);
    if (state && state->head<2>().norm() > kSlowestMps) {
      directions_rad.push_back(mount_yaw_rad + std::atan2((*state)[1], (*state)[0]));
      sum += Eigen::Vector2d(std::cos(directions_rad.back()), std::sin(directions_rad.back()));
    }
  }
  if (directions_rad.empty()) {
    return std::nullopt;
  }
  const double mean_rad = std::atan2(sum.y(), sum.x());
  for (double& direction : directions_rad) {
    direction = wrapped(direction - mean_rad);
  }
  return wrapped(mean_rad + median_or(0.0, directions_rad.begin(), directions_rad.end()));
}

/// A radar that by its mount moves sideways, as none on a vehicle does, or backwards as few of them
/// do, gets the yaw with which it moves ahead. The fit would take that for a turn of the vehicle
/// about itself. If most of them move backwards the vehicle does; if just half of them do, who is
/// wrong is not known.
Configuration turned_along(Configuration configuration,
                           const std::vector<RecordedRadar>& recorded) {
  constexpr double kSidewaysRad = 0.25 * std::numbers::pi;
  constexpr double kBackwardsRad = 0.75 * std::numbers::pi;
  const auto yaw_rad = [&](std::size_t i) -> double& {
    return configuration.radars[i].ego_motion.vehicle_from_radar.yaw_rad;
  };
  std::vector<std::optional<double>> off_rad;
  int moving = 0;
  int moving_back = 0;
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    off_rad.push_back(direction_rad(recorded[i], yaw_rad(i)));
    moving += off_rad[i] ? 1 : 0;
    moving_back += off_rad[i] && std::abs(*off_rad[i]) > kBackwardsRad ? 1 : 0;
  }
  const double along_rad = 2 * moving_back > moving ? std::numbers::pi : 0.0;
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    const double by_rad = wrapped(off_rad[i].value_or(along_rad) - along_rad);
    const bool is_against = std::abs(by_rad) > kBackwardsRad;
    if (is_against ? 2 * moving_back != moving : std::abs(by_rad) > kSidewaysRad) {
      yaw_rad(i) = wrapped(yaw_rad(i) - by_rad);
    }
  }
  return configuration;
}

bool has_rotation_lead(const RadarConfiguration& radar) {
  return radar.decoder.rotation_lead_s().value_or(0.0) != 0.0;
}

std::vector<FittedRadar> start(const Configuration& configuration, bool has_truth,
                               const SystematicErrors& errors) {
  std::vector<FittedRadar> radars;
  for (const RadarConfiguration& radar : configuration.radars) {
    radars.push_back({configured(radar), kPriorStd, configured(radar), {}});
    radars.back().prior_std[kDopplerAzimuth] = errors.doppler_azimuth;
    radars.back().prior_std[kMatchedTurn] = errors.turn;
    if (!has_rotation_lead(radar)) {
      radars.back().prior_std[kLead] = 0.0;
    }
  }
  if (!has_truth) {
    for (const CalibrationState state : {kY, kStamp, kScale}) {
      radars.front().prior_std[state] = 0.0;
    }
  }
  return radars;
}

FittedVehicle vehicle_start(const Configuration& configuration, bool has_truth) {
  FittedVehicle vehicle;
  vehicle.prior_std = kVehiclePriorStd;
  if (!has_truth) {
    vehicle.prior_std[kRoll] = configuration.odometry.filter.slip_std_rad;
  }
  return vehicle;
}

MotionPrior motion_prior(const Configuration& configuration) {
  const auto& errors = configuration.radars.front().ego_motion.registration.shared_errors;
  return {errors.acceleration_std_mps2, errors.yaw_acceleration_std_radps2,
          errors.velocity_std_mps};
}

std::vector<double> mount_yaw_stds(const Configuration& configuration) {
  std::vector<double> result;
  for (const RadarConfiguration& radar : configuration.radars) {
    result.push_back(radar.ego_motion.registration.shared_errors.mount_yaw_std_rad);
  }
  return result;
}

double std_with(const SystematicErrors& errors, std::size_t state, double std) {
  return state == kOffset ? std::hypot(std, errors.doppler_offset) : std;
}

/// Odometry depends most on the mount's yaw: an estimate replaces it as soon as its standard
/// deviation reaches `yaw_std_rad`, that of the configured one.
bool is_better(const FittedRadar& radar, CalibrationState state, double yaw_std_rad,
               const SystematicErrors& errors) {
  const double change = std::abs(radar.value[state] - radar.prior[state]);
  const bool is_good_yaw = state == kYaw && radar.std[kYaw] <= yaw_std_rad;
  return radar.prior_std[state] > 0.0 && radar.std[state] <= kWorstStd[state] &&
         (is_good_yaw || change > kSignificant * std_with(errors, state, radar.std[state]));
}

/// A factor below one is ignored: a few large errors matter more than many small ones, and
/// estimates would become overconfident.
double above_one(const StdFactor& factor) {
  return factor.value > 1.0 + kSignificant * factor.std ? factor.value : 1.0;
}

/// Scans need neither odometry nor motions, which take most of the time: no scan has enough
/// targets.
Configuration without_motions(Configuration configuration) {
  configuration.odometry.enabled = false;
  for (RadarConfiguration& radar : configuration.radars) {
    radar.ego_motion.min_targets = kMaxDetections + 1;
  }
  return configuration;
}

/// Throws if truth tells nothing of these scans.
void check_overlap(const std::vector<RecordedRadar>& recorded, const TrueTrajectory& truth) {
  for (const RecordedRadar& radar : recorded) {
    if (std::ranges::any_of(radar.scans, [&](const RecordedScan& scan) {
          return truth.at(scan.stamp_us).has_value();
        })) {
      return;
    }
  }
  throw std::runtime_error(
      concat({"truth: its time, ", told_time(truth.utime_us()),
              ", has no scan of the logs in it; is it of this drive, in microseconds?"}));
}

/// State of one calibration.
class Calibrator {
 public:
  Calibrator(const Configuration& configuration, const std::vector<std::string>& logs,
             std::vector<RecordedRadar> recorded, const TrueTrajectory* truth,
             const SystematicErrors& errors)
      : configuration_(configuration),
        logs_(logs),
        has_truth_(truth != nullptr),
        errors_(errors),
        recorded_(std::move(recorded)),
        fit_(start(configuration, has_truth_, errors), vehicle_start(configuration, has_truth_),
             motion_prior(configuration)),
        radars_(configuration.radars.size()) {
    fit_.set_truth(truth);
    if (has_truth_) {
      check_overlap(recorded_, *truth);
    } else {
      fit_.trust_yaws(mount_yaw_stds(configuration));
    }
    for (std::size_t i = 0; i < radars_.size(); ++i) {
      radars_[i].scans = recorded_[i].scans.size();
    }
    solve();
    choose_changes();
    is_started_ = true;
  }

  void refine() {
    if (round_ < kRegisteredRounds) {
      registered_ = record_drive(trial(), logs_).radars;
    }
    for (std::size_t i = 0; i < radars_.size(); ++i) {
      radars_[i].noise = measured_noise(recorded_[i].scans, fit_, i, radars_[i].noise);
    }
    solve();
    choose_changes();
    ++round_;
  }

  void finish() {
    settle();
    check();
  }

  [[nodiscard]] Calibration result() const {
    Calibration result{
        .radars = radars_, .vehicle = fit_.vehicle(), .has_truth = has_truth_, .check = check_};
    for (RadarCalibration& radar : result.radars) {
      for (FittedRadar* fitted : {&radar.free, &radar.fit}) {
        fitted->std[kOffset] = std_with(errors_, kOffset, fitted->std[kOffset]);
      }
    }
    result.vehicle.std[kSlip] = slip_std();
    result.is_slip_refused = is_slip_refused_;
    result.is_slip_changed = is_slip_checked_ && !is_slip_refused_ && is_slip_better();
    return result;
  }

 private:
  [[nodiscard]] std::vector<VelocityMeasurement> velocities() const {
    std::vector<VelocityMeasurement> result;
    for (std::size_t radar = 0; radar < recorded_.size(); ++radar) {
      for (const RecordedScan& scan : recorded_[radar].scans) {
        const auto state = state_of(radar, scan);
        if (!state || state->head<2>().norm() < kSlowestMps) {
          continue;
        }
        const RecordedScan fixed = static_part(scan, *state);
        if (fixed.targets.empty()) {
          continue;
        }
        result.push_back({radar, scan.stamp_us, doppler_equations(fixed, *state, noise(radar))});
      }
    }
    return result;
  }

  /// In the first round a scan's own targets must agree; later the fitted motion decides.
  [[nodiscard]] std::optional<DopplerState> state_of(std::size_t radar,
                                                     const RecordedScan& scan) const {
    return is_started_ ? fit_.expected(radar, scan.stamp_us) : agreed_velocity(scan.targets);
  }

  [[nodiscard]] DopplerNoise noise(std::size_t radar) const {
    return {
        radars_[radar].noise.doppler.value, radars_[radar].noise.azimuth.value,
        configuration_.radars[radar].ego_motion.registration.shared_errors.doppler_offset_std_mps,
        kSharedVelocityStdMps};
  }

  /// Registers positions alone, in the frame of the rolling direction. Lateral motion is free in
  /// the first round, because a wrong mount would otherwise turn into yaw; later it would only make
  /// yaw less precise.
  [[nodiscard]] Configuration trial() const {
    Configuration result = calibrated(configuration_, {.radars = radars_});
    for (std::size_t i = 0; i < result.radars.size(); ++i) {
      EgoMotionOptions& options = result.radars[i].ego_motion;
      options.registration.doppler.enabled = false;
      if (round_ == 0) {
        options.registration.degrees_of_freedom = 3;
      }
      options.vehicle_from_radar.yaw_rad -= fit_.vehicle().value[kRoll];
      const DetectionCorrection& configured = configuration_.radars[i].ego_motion.correction;
      options.correction.rotation_lead_s = configured.rotation_lead_s;
      options.correction.azimuth_scale = configured.azimuth_scale;
      result.radars[i].stamp_offset_s = configuration_.radars[i].stamp_offset_s;
    }
    return result;
  }

  [[nodiscard]] std::vector<YawRateMeasurement> yaw_rates() const {
    std::vector<YawRateMeasurement> result;
    for (std::size_t radar = 0; radar < registered_.size(); ++radar) {
      std::vector<ScaledError> errors;
      const std::size_t first = result.size();
      for (const EgoMotion& motion : registered_[radar].motions) {
        const double dt_s = static_cast<double>(motion.utime_us - motion.utime_start_us) * 1e-6;
        const std::int64_t middle_us = motion.utime_start_us + std::llround(dt_s * 0.5e6);
        const FittedRadar& fit = fit_.radars()[radar];
        const auto expected = fit_.motion(radar, middle_us, fit.value[kPositionLead]);
        if (!expected) {
          continue;
        }
        result.push_back(
            {radar, kTurn, middle_us, motion.motion.z() / dt_s,
             std::hypot(std::sqrt(motion.covariance(2, 2)) / dt_s, kLeastYawRateStdRadps)});
        errors.push_back({middle_us,
                          (result.back().yaw_rate_radps - expected->y()) / result.back().std_radps,
                          0.0});
      }
      // Some radars report too small standard deviations.
      const double factor = std::max(noise_factor(errors).value, 1.0);
      for (std::size_t i = first; i < result.size(); ++i) {
        result[i].std_radps *= factor;
      }
      const auto turns =
          matched_turns(recorded_[radar].scans, fit_, radar, radars_[radar].noise.azimuth.value);
      result.insert(result.end(), turns.begin(), turns.end());
    }
    return result;
  }

  /// Without truth, the configured yaw that is to be improved on is that from the rolling
  /// direction.
  [[nodiscard]] double yaw_std_rad(std::size_t radar) const {
    const auto& errors = configuration_.radars[radar].ego_motion.registration.shared_errors;
    return std::hypot(errors.mount_yaw_std_rad,
                      has_truth_ ? 0.0 : configuration_.odometry.filter.slip_std_rad);
  }

  [[nodiscard]] double configured_slip() const {
    return configuration_.odometry.filter.slip_per_lateral_acceleration;
  }

  [[nodiscard]] double slip_std() const {
    return std::hypot(fit_.vehicle().std[kSlip], errors_.slip);
  }

  [[nodiscard]] bool is_slip_better() const {
    const double change = std::abs(fit_.vehicle().value[kSlip] - configured_slip());
    return slip_std() <= kWorstSlipStd && change > kSignificant * slip_std();
  }

  void choose_changes() {
    for (std::size_t i = 0; i < radars_.size(); ++i) {
      radars_[i].free = radars_[i].fit;
      for (const CalibrationState state : kTold) {
        radars_[i].is_changed[state] = is_better(radars_[i].free, state, yaw_std_rad(i), errors_);
      }
    }
  }

  /// A value that is kept is known as well as by a tape measure.
  void limit_kept() {
    for (std::size_t i = 0; i < radars_.size(); ++i) {
      for (const CalibrationState state : kTold) {
        if (!radars_[i].is_changed[state]) {
          fit_.limit(i, state, kWorstStd[state]);
        }
      }
    }
  }

  /// Keeps those configured values that the others, once kept, leave no better.
  bool drop_changes() {
    bool is_dropped = false;
    for (std::size_t i = 0; i < radars_.size(); ++i) {
      for (const CalibrationState state : kTold) {
        bool& is_changed = radars_[i].is_changed[state];
        if (is_changed && !is_better(radars_[i].fit, state, yaw_std_rad(i), errors_)) {
          is_changed = false;
          is_dropped = true;
        }
      }
    }
    return is_dropped;
  }

  void settle() {
    do {
      limit_kept();
      solve();
    } while (drop_changes());
  }

  /// Refuses what fits no better in the parts of the drive where it was not found.
  void check() {
    std::vector<ChangedStates> changed;
    is_slip_checked_ = is_slip_better();
    bool is_any = is_slip_checked_;
    for (const RadarCalibration& radar : radars_) {
      changed.push_back(radar.is_changed);
      is_any = is_any || std::ranges::any_of(changed.back(), [](bool is) { return is; });
    }
    if (!is_any) {
      return;
    }
    check_ = check_held_out(fit_, changed,
                            is_slip_checked_ ? std::optional(configured_slip()) : std::nullopt);
    is_slip_refused_ = is_slip_checked_ && !(check_->is_better && check_->is_slip_better);
    bool is_any_refused = false;
    for (std::size_t i = 0; i < radars_.size(); ++i) {
      if (!check_->is_better || !check_->is_radar_better[i]) {
        radars_[i].is_refused = std::ranges::any_of(changed[i], [](bool is) { return is; });
        radars_[i].is_changed = {};
        is_any_refused = is_any_refused || radars_[i].is_refused;
      }
    }
    if (is_any_refused) {
      settle();
    }
  }

  void solve() {
    const std::vector<VelocityMeasurement> measured = velocities();
    if (measured.empty()) {
      throw std::runtime_error(
          concat({logs_.front(),
                  ": the vehicle does not move; calibration needs two minutes of "
                  "driving with bends, starts and stops"}));
    }
    fit_.set_measurements(measured, is_started_ ? yaw_rates() : std::vector<YawRateMeasurement>{});
    fit_.solve();
    for (std::size_t i = 0; i < radars_.size(); ++i) {
      radars_[i].fit = fit_.radars()[i];
      radars_[i].explained_scans =
          static_cast<std::size_t>(std::ranges::count(measured, i, &VelocityMeasurement::radar));
    }
  }

  const Configuration& configuration_;
  const std::vector<std::string>& logs_;
  bool has_truth_;
  SystematicErrors errors_;
  std::vector<RecordedRadar> recorded_;
  std::vector<RecordedRadar> registered_;
  CalibrationFit fit_;
  bool is_started_ = false;
  int round_ = 0;
  std::vector<RadarCalibration> radars_;
  std::optional<HeldOutCheck> check_;
  bool is_slip_checked_ = false;
  bool is_slip_refused_ = false;
};

}  // namespace

Calibration calibrate(const Configuration& configuration, const std::vector<std::string>& logs,
                      const TrueTrajectory* truth, const SystematicErrors& errors) {
  std::vector<RecordedRadar> recorded = record_drive(without_motions(configuration), logs).radars;
  const Configuration along = turned_along(configuration, recorded);
  Calibrator calibrator(along, logs, std::move(recorded), truth, errors);
  for (int round = 0; round < kRounds; ++round) {
    calibrator.refine();
  }
  calibrator.finish();
  Calibration result = calibrator.result();
  for (std::size_t i = 0; i < result.radars.size(); ++i) {
    RadarCalibration& radar = result.radars[i];
    radar.turned_rad = wrapped(along.radars[i].ego_motion.vehicle_from_radar.yaw_rad -
                               configuration.radars[i].ego_motion.vehicle_from_radar.yaw_rad);
    radar.is_changed[kYaw] = radar.is_changed[kYaw] || radar.turned_rad != 0.0;
  }
  return result;
}

double key_value(const RadarConfiguration& configured, CalibrationState state, double found) {
  const DetectionCorrection& correction = configured.ego_motion.correction;
  switch (state) {
    case kOffset:
      return correction.doppler_offset_mps + found / correction.doppler_scale;
    case kStamp:
      return configured.stamp_offset_s + found;
    case kScale:
      return correction.doppler_scale / (1.0 + found);
    case kLead:
    case kPositionLead:
      return correction.rotation_lead_s + found;
    case kAzimuth:
      return correction.azimuth_scale * (1.0 + found);
    default:
      return found;
  }
}

Configuration calibrated(const Configuration& configuration, const Calibration& calibration) {
  Configuration result = configuration;
  if (calibration.is_slip_changed) {
    result.odometry.filter.slip_per_lateral_acceleration = calibration.vehicle.value[kSlip];
  }
  for (std::size_t i = 0; i < result.radars.size(); ++i) {
    RadarConfiguration& radar = result.radars[i];
    const RadarCalibration& found = calibration.radars[i];
    CalibrationVector value{};
    for (std::size_t state = 0; state < kCalibrationStates; ++state) {
      value[state] =
          key_value(configuration.radars[i], static_cast<CalibrationState>(state),
                    found.is_changed[state] ? found.fit.value[state] : found.fit.prior[state]);
    }
    if (found.is_changed[kYaw]) {
      value[kYaw] = wrapped(value[kYaw]);
    }
    radar.ego_motion.vehicle_from_radar = {value[kX], value[kY], value[kYaw]};
    radar.stamp_offset_s = value[kStamp];
    DetectionCorrection& correction = radar.ego_motion.correction;
    correction.doppler_offset_mps = value[kOffset];
    correction.doppler_scale = value[kScale];
    correction.rotation_lead_s = value[kLead];
    correction.azimuth_scale = value[kAzimuth];
    correction.range_std_factor *= above_one(found.noise.range);
    correction.azimuth_std_factor *= above_one(found.noise.azimuth);
    correction.doppler_std_factor *= above_one(found.noise.doppler);
  }
  return result;
}

}  // namespace cremed
