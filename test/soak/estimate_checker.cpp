// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "test/soak/estimate_checker.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>

namespace cremed::soak {
namespace {

constexpr std::int64_t kStaleUs = 1'000'000;

double seconds(std::int64_t us) { return static_cast<double>(us) * 1e-6; }

bool is_symmetric(const Eigen::Matrix3d& c) { return (c.array() == c.transpose().array()).all(); }

/// A radar on a car estimates x and yaw; y is exactly 0.
bool is_definite_in_x_and_yaw(const Eigen::Matrix3d& c) {
  return is_symmetric(c) && c.row(1).isZero(0.0) && c(0, 0) > 0.0 && c(2, 2) > 0.0 &&
         c(0, 0) * c(2, 2) > c(0, 2) * c(0, 2);
}

bool is_definite(const Eigen::Matrix3d& c) {
  return is_symmetric(c) && c.llt().info() == Eigen::Success;
}

}  // namespace

bool Comparison::is_beyond() const {
  // Negated, so that NaN counts as too large.
  return !(std::abs(x_error_sigma) <= kMaxSigmas && std::abs(yaw_error_sigma) <= kMaxSigmas);
}

void Tally::add(const Comparison& comparison) {
  ++estimates;
  beyond_x += std::abs(comparison.x_error_sigma) <= kMaxSigmas ? 0 : 1;
  beyond_yaw += std::abs(comparison.yaw_error_sigma) <= kMaxSigmas ? 0 : 1;
  beyond += comparison.is_beyond() ? 1 : 0;
}

Tally& Tally::operator+=(const Tally& other) {
  estimates += other.estimates;
  beyond_x += other.beyond_x;
  beyond_yaw += other.beyond_yaw;
  beyond += other.beyond;
  return *this;
}

EstimateChecker::EstimateChecker(const Configuration& configuration, const FaultInjector& source)
    : source_(source) {
  for (std::size_t i = 0; i < kRadars; ++i) {
    options_[i] = configuration.radars[i].ego_motion;
  }
  options_[kFused] = options_[0];
  options_[kFused].max_gap_s = configuration.odometry.filter.max_gap_s;
  options_[kFused].standstill_mps = configuration.odometry.filter.standstill_mps;
  found_.reserve(kKept);
  beyond_.reserve(kKept);
}

void EstimateChecker::begin(const SoakDrive& drive) { drive_ = &drive; }

void EstimateChecker::on_clock_step() {
  for (Past& past : past_) {
    past.has_estimate = false;
    past.scan_stamps.fill(0);
  }
}

void EstimateChecker::on_motion(std::size_t radar, const EgoMotion& motion,
                                std::int32_t /*solve_us*/) {
  Past& past = past_[radar];
  past.scan_stamps[past.next_stamp] = motion.utime_us;
  past.next_stamp = (past.next_stamp + 1) % past.scan_stamps.size();
  check(radar, motion);
}

void EstimateChecker::on_fused(const EgoMotion& motion, std::int32_t /*solve_us*/) {
  check(kFused, motion);
}

void EstimateChecker::on_odometry(const Odometry& odometry) {
  EgoMotion motion;
  motion.utime_start_us = odometry.utime_anchor_us;
  motion.utime_us = odometry.utime_us;
  motion.status = MotionStatus::ok;
  motion.motion = odometry.pose;
  motion.covariance = odometry.covariance;
  check_covariance(kOdometry, motion);
  if (odometry.is_usable()) {
    compare(kOdometry, motion);
  }
}

void EstimateChecker::check(std::size_t radar, const EgoMotion& motion) {
  ++past_[radar].motions;
  expect(source_.now_us() - source_.true_us(motion.utime_us) <= kStaleUs, Violation::stale, radar,
         motion);
  if (!motion.has_estimate()) {
    check_without(radar, motion);
    return;
  }
  check_times(radar, motion);
  check_covariance(radar, motion);
  check_speed(radar, motion);
  compare(radar, motion);
}

void EstimateChecker::check_without(std::size_t radar, const EgoMotion& motion) {
  expect(motion.motion.array().isNaN().all() && motion.covariance.array().isNaN().all(),
         Violation::status_contradicts, radar, motion);
}

void EstimateChecker::check_times(std::size_t radar, const EgoMotion& motion) {
  Past& past = past_[radar];
  if (past.has_estimate) {
    expect(motion.utime_us > past.last_estimate_us, Violation::time_not_increasing, radar, motion);
    expect(motion.utime_start_us >= past.last_estimate_us, Violation::estimates_overlap, radar,
           motion);
  }
  const double span_s = seconds(motion.utime_us - motion.utime_start_us);
  expect(span_s > 0.0 && span_s <= options_[radar].max_gap_s, Violation::gap_too_long, radar,
         motion);
  expect(is_scan(radar, motion.utime_start_us), Violation::spans_clock_step, radar, motion);
  past.last_estimate_us = motion.utime_us;
  past.has_estimate = true;
}

/// The fused estimate starts at a scan of any radar.
bool EstimateChecker::is_scan(std::size_t source, std::int64_t stamp_us) const {
  const auto has = [&](const Past& past) {
    return std::find(past.scan_stamps.begin(), past.scan_stamps.end(), stamp_us) !=
           past.scan_stamps.end();
  };
  return source == kFused ? std::any_of(past_.begin(), past_.end(), has) : has(past_[source]);
}

FaultSet EstimateChecker::faults_since(std::size_t source, std::int64_t start_us) const {
  if (source < kRadars) {
    return source_.faults_since(source, start_us);
  }
  FaultSet all = 0;
  for (std::size_t radar = 0; radar < kRadars; ++radar) {
    all |= source_.faults_since(radar, start_us);
  }
  return all;
}

void EstimateChecker::check_covariance(std::size_t radar, const EgoMotion& motion) {
  expect(motion.motion.allFinite() && motion.covariance.allFinite(), Violation::not_finite, radar,
         motion);
  expect(radar < kRadars ? is_definite_in_x_and_yaw(motion.covariance)
                         : is_definite(motion.covariance),
         Violation::not_definite, radar, motion);
}

void EstimateChecker::check_speed(std::size_t radar, const EgoMotion& motion) {
  const double span_s = seconds(motion.utime_us - motion.utime_start_us);
  const double speed_mps = std::abs(motion.motion.x()) / span_s;
  const bool stands = motion.status == MotionStatus::standing_still;
  expect((radar == kFused || motion.motion.y() == 0.0) &&
             speed_mps <= options_[radar].max_speed_mps &&
             (!stands || speed_mps <= options_[radar].standstill_mps * (1.0 + 1e-9)),
         Violation::status_contradicts, radar, motion);
}

void EstimateChecker::compare(std::size_t radar, const EgoMotion& motion) {
  const std::int64_t start_us = source_.true_us(motion.utime_start_us);
  const std::int64_t end_us = source_.true_us(motion.utime_us);
  const Eigen::Vector3d error = motion.motion - drive_->motion(start_us, end_us);
  const VehicleState start = drive_->at(start_us);
  const VehicleState end = drive_->at(end_us);
  Comparison c;
  c.radar = radar;
  c.scenario = drive_->scenario;
  c.drive_s = drive_->simulation.scene().seconds(end_us);
  c.span_s = seconds(end_us - start_us);
  c.speed_mps = end.speed_mps;
  c.acceleration_mps2 = (end.speed_mps - start.speed_mps) / c.span_s;
  c.x_sigma_m = std::sqrt(motion.covariance(0, 0));
  c.yaw_sigma_rad = std::sqrt(motion.covariance(2, 2));
  c.x_error_sigma = error.x() / c.x_sigma_m;
  c.yaw_error_sigma = error.z() / c.yaw_sigma_rad;
  c.targets = motion.targets;
  c.faults = faults_since(radar, start_us);

  RadarTallies& tallies = tallies_[radar];
  tallies.by_scenario[c.scenario].add(c);
  for (std::size_t i = 0; i < kFaults.size(); ++i) {
    if ((c.faults >> i & 1U) != 0) {
      tallies.by_fault[i].add(c);
    }
  }
  if (c.faults == 0) {
    tallies.without_fault.add(c);
  }
  const auto class_mps2 = static_cast<std::size_t>(std::abs(c.acceleration_mps2));
  tallies.by_acceleration[std::min(class_mps2, tallies.by_acceleration.size() - 1)].add(c);
  if (c.is_beyond() && beyond_.size() < kKept && beyond_reported_ < kMaxReported) {
    beyond_.push_back(c);
    ++beyond_reported_;
  }
}

void EstimateChecker::on_status(std::size_t radar, const RadarStatus& status) {
  const std::uint64_t answered = std::accumulate(status.motions_by_status.begin(),
                                                 status.motions_by_status.end(), std::uint64_t{0});
  expect(answered == past_[radar].motions && answered == status.assembler.scans,
         Violation::scan_unanswered, radar, {});
}

void EstimateChecker::violate(Violation violation, std::size_t radar, const EgoMotion& motion) {
  constexpr std::uint64_t kShownOfEach = 5;
  if (++counts_[static_cast<std::size_t>(violation)] <= kShownOfEach && found_.size() < kKept) {
    found_.push_back(
        {violation, radar, drive_->simulation.scene().seconds(source_.now_us()), motion});
  }
}

std::uint64_t EstimateChecker::violations() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0});
}

std::vector<Found> EstimateChecker::take_found() {
  std::vector<Found> result = found_;
  found_.clear();
  return result;
}

std::vector<Comparison> EstimateChecker::take_beyond() {
  std::vector<Comparison> result = beyond_;
  beyond_.clear();
  return result;
}

}  // namespace cremed::soak
