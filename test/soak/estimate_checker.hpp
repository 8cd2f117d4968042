// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "daemon/output/odometry_sink.hpp"
#include "test/soak/fault_injector.hpp"
#include "test/soak/fault_kind.hpp"
#include "test/soak/soak_drive.hpp"

namespace cremed::soak {

inline constexpr std::size_t kRadars = 2;
inline constexpr double kMaxSigmas = 5.0;

/// Faults that no result may have, whatever the input.
enum class Violation : std::uint8_t {
  not_finite,
  not_definite,
  status_contradicts,
  time_not_increasing,
  estimates_overlap,
  gap_too_long,
  spans_clock_step,
  stale,
  scan_unanswered,
};
inline constexpr std::array<std::string_view, 9> kViolationNames{
    "estimate or covariance not finite",
    "covariance not symmetric and positive definite",
    "status contradicts what it comes with",
    "utime not later than that of the estimate before",
    "starts before the end of the estimate before",
    "spans more than max_gap_s",
    "starts at no scan of this clock",
    "published more than a second late",
    "number of results is not that of scans",
};

/// Sources after the radars: the fused motion, and the odometry's pose relative to its anchor.
inline constexpr std::size_t kFused = kRadars;
inline constexpr std::size_t kOdometry = kRadars + 1;
inline constexpr std::size_t kSources = kRadars + 2;

/// An estimate and the truth.
struct Comparison {
  std::size_t radar = 0;
  std::size_t scenario = 0;
  double drive_s = 0.0;
  double span_s = 0.0;
  double speed_mps = 0.0;
  double acceleration_mps2 = 0.0;
  double x_error_sigma = 0.0;
  double yaw_error_sigma = 0.0;
  double x_sigma_m = 0.0;
  double yaw_sigma_rad = 0.0;
  int targets = 0;
  FaultSet faults = 0;  ///< On its bus since the estimate's start.

  [[nodiscard]] bool is_beyond() const;
};

struct Found {
  Violation violation;
  std::size_t radar;
  double drive_s;
  EgoMotion motion;
};

/// Number of estimates of a kind, and of those with errors beyond their covariance.
struct Tally {
  std::uint64_t estimates = 0;
  std::uint64_t beyond_x = 0;
  std::uint64_t beyond_yaw = 0;
  std::uint64_t beyond = 0;

  void add(const Comparison& comparison);
  Tally& operator+=(const Tally& other);
};

struct RadarTallies {
  std::array<Tally, kScenarios.size()> by_scenario{};
  std::array<Tally, kFaults.size()> by_fault{};  ///< An estimate counts under each of its faults.
  Tally without_fault;
  std::array<Tally, 4> by_acceleration{};  ///< Below 1, 2, 3 m/s^2, and the rest.
};

/// Checks every result without allocation.
class EstimateChecker final : public OdometrySink {
 public:
  EstimateChecker(const Configuration& configuration, const FaultInjector& source);

  /// Sets the drive for the next results.
  void begin(const SoakDrive& drive);
  void on_clock_step();

  void on_motion(std::size_t radar, const EgoMotion& motion, std::int32_t solve_us) override;
  void on_odometry(const Odometry& odometry) override;
  void on_fused(const EgoMotion& motion, std::int32_t solve_us) override;
  void on_scan(std::size_t, const RadarScan&) override {}
  void on_status(std::size_t radar, const RadarStatus& status) override;
  [[nodiscard]] std::uint64_t failures() const override { return violations(); }

  [[nodiscard]] std::uint64_t violations() const;
  [[nodiscard]] const std::array<RadarTallies, kSources>& tallies() const { return tallies_; }
  [[nodiscard]] const std::array<std::uint64_t, kViolationNames.size()>& counts() const {
    return counts_;
  }

  /// The first few of each since the last call.
  std::vector<Found> take_found();
  std::vector<Comparison> take_beyond();

 private:
  static constexpr std::size_t kKept = 16;
  static constexpr std::size_t kMaxReported = 40;

  /// History of one radar.
  struct Past {
    std::int64_t last_estimate_us = 0;
    bool has_estimate = false;
    std::array<std::int64_t, 64> scan_stamps{};  ///< A ring; 0: none.
    std::size_t next_stamp = 0;
    std::uint64_t motions = 0;
  };

  void check(std::size_t source, const EgoMotion& motion);
  [[nodiscard]] bool is_scan(std::size_t source, std::int64_t stamp_us) const;
  [[nodiscard]] FaultSet faults_since(std::size_t source, std::int64_t start_us) const;
  void check_without(std::size_t radar, const EgoMotion& motion);
  void check_times(std::size_t radar, const EgoMotion& motion);
  void check_covariance(std::size_t radar, const EgoMotion& motion);
  void check_speed(std::size_t radar, const EgoMotion& motion);
  void compare(std::size_t radar, const EgoMotion& motion);
  void violate(Violation violation, std::size_t radar, const EgoMotion& motion);
  void expect(bool condition, Violation violation, std::size_t radar, const EgoMotion& motion) {
    if (!condition) {
      violate(violation, radar, motion);
    }
  }

  const FaultInjector& source_;
  std::array<EgoMotionOptions, kSources> options_;
  const SoakDrive* drive_ = nullptr;
  std::array<Past, kSources> past_{};
  std::array<RadarTallies, kSources> tallies_{};
  std::array<std::uint64_t, kViolationNames.size()> counts_{};
  std::vector<Found> found_;
  std::vector<Comparison> beyond_;
  std::size_t beyond_reported_ = 0;
};

}  // namespace cremed::soak
