// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "test/tools/seen_from.hpp"
#include "test/tools/simulated_drive.hpp"

namespace {

using cremed::Detection;
using cremed::Echo;
using cremed::EchoKind;
using cremed::test::Drive;
using cremed::test::Polar;
using cremed::test::seen_from;
using cremed::test::TruthTable;

constexpr std::uint64_t kSeeds = 2;

/// Normalised errors of one detection: range, azimuth, Doppler.
using Errors = std::array<double, 3>;

/// The velocity is the difference quotient of the position in the radar's frame over +-10 ms, from
/// the truth file alone; Doppler is its component along the reported line of sight.
Errors errors_of(const Detection& detection, const Echo& echo, const TruthTable& truth,
                 const cremed::RadarConfiguration& radar, std::int64_t stamp_us) {
  const auto vehicle = [&](double offset_us) {
    return truth.at(static_cast<double>(stamp_us) + offset_us);
  };
  const auto at = [&](double offset_us) {
    return seen_from(vehicle(offset_us), radar.ego_motion.vehicle_from_radar, echo.x_m, echo.y_m);
  };
  const double yaw_rate_radps = (vehicle(10'000.0).yaw_rad - vehicle(-10'000.0).yaw_rad) / 0.02;
  const Polar before = at(-10'000.0);
  const Polar now = at(0.0);
  const Polar after = at(10'000.0);
  const double azimuth_rad =
      now.azimuth_rad - radar.ego_motion.correction.rotation_lead_s * yaw_rate_radps;
  const double doppler_mps = (after.range_m * std::cos(after.azimuth_rad - azimuth_rad) -
                              before.range_m * std::cos(before.azimuth_rad - azimuth_rad)) /
                             0.02;
  return {
      (detection.range_m - now.range_m) / detection.range_std_m,
      std::remainder(detection.azimuth_rad - azimuth_rad, 2.0 * M_PI) / detection.azimuth_std_rad,
      (detection.doppler_mps - doppler_mps) / detection.doppler_std_mps};
}

struct ScanErrors {
  std::vector<Errors> errors;
  std::vector<std::pair<double, double>> places;  ///< Positions of these targets.
};

bool inside(const TruthTable& truth, std::int64_t stamp_us) {
  return stamp_us > truth.rows().front().stamp_us + 10'000 &&
         stamp_us < truth.rows().back().stamp_us - 10'000;
}

/// Errors of all static targets of one radar, by scan.
std::vector<ScanErrors> radar_errors(const Drive& drive, std::size_t radar) {
  const TruthTable truth(drive.truth_csv);
  const auto decoded = cremed::test::decode(drive.log(), drive.radars[radar]);
  std::vector<ScanErrors> all;
  std::size_t scan_index = 0;
  for (const auto& scan_truth : drive.truths) {
    if (scan_truth.radar != radar) continue;
    const auto& scan = decoded.scans.at(scan_index++);
    REQUIRE(scan.status == cremed::ScanStatus::complete);
    REQUIRE(scan.stamp_us == scan_truth.stamp_us);
    REQUIRE(scan.count == scan_truth.echoes.size());
    if (!inside(truth, scan.stamp_us)) continue;
    ScanErrors& errors = all.emplace_back();
    for (std::size_t i = 0; i < scan.count; ++i) {
      const Echo& echo = scan_truth.echoes[i];
      if (echo.kind != EchoKind::fixed) continue;
      errors.errors.push_back(
          errors_of(scan.detections[i], echo, truth, drive.radars[radar], scan.stamp_us));
      errors.places.emplace_back(echo.x_m, echo.y_m);
    }
  }
  CHECK(scan_index == decoded.scans.size());
  return all;
}

/// Mean and variance of numbers that should be standard normal.
class Moments {
 public:
  void add(double value) {
    ++count_;
    sum_ += value;
    squares_ += value * value;
  }
  [[nodiscard]] double count() const { return count_; }
  [[nodiscard]] double mean() const { return sum_ / count_; }
  [[nodiscard]] double mean_square() const { return squares_ / count_; }

 private:
  double count_ = 0.0;
  double sum_ = 0.0;
  double squares_ = 0.0;
};

/// The bound of 4.5 standard deviations is exceeded by chance once in 150 000; `slack` is for the
/// second order that the polar standard deviations omit.
void check_standard_normal(const Moments& moments, double slack) {
  CHECK(std::abs(moments.mean()) < 4.5 / std::sqrt(moments.count()) + slack);
  CHECK(std::abs(moments.mean_square() - 1.0) < 4.5 * std::sqrt(2.0 / moments.count()) + slack);
}

constexpr std::array<const char*, 3> kComponents{"range", "azimuth", "doppler"};
constexpr std::size_t kClusters = 0;  // Indices in one_of_each_kind().
constexpr std::size_t kGprRadar = 1;

constexpr double kSharedMps = 0.15;
constexpr double kReportedMps = 0.125;  // For every target of the simulated GPR.

std::vector<ScanErrors> errors_over_seeds(const std::string& name, std::size_t radar,
                                          double doppler_offset_std_mps = 0.0) {
  std::vector<ScanErrors> all;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    cremed::SimulationOptions options;
    options.seed = seed;
    options.doppler_offset_std_mps = doppler_offset_std_mps;
    options.body_velocity_std_mps = 0.0;
    const Drive drive =
        cremed::test::drive(cremed::test::scenario(name), {cremed::test::one_of_each_kind()[radar]},
                            cremed::test::exactly_mounted(options));
    for (ScanErrors& errors : radar_errors(drive, 0)) all.push_back(std::move(errors));
  }
  return all;
}

double sum_of(const ScanErrors& scan, std::size_t component) {
  double sum = 0.0;
  for (const Errors& errors : scan.errors) sum += errors[component];
  return sum;
}

}  // namespace

TEST_CASE("errors of standing targets have the standard deviations that are reported") {
  const std::string name =
      GENERATE("straight", "bends", "stop-and-go", "standing", "city", "crowd", "desert");
  const std::size_t radar = GENERATE(0U, 1U, 2U, 3U);
  CAPTURE(name, cremed::test::one_of_each_kind()[radar].name);
  const auto scans = errors_over_seeds(name, radar);
  for (std::size_t component = 0; component < kComponents.size(); ++component) {
    Moments single;
    Moments shared;  // Per scan: shows errors that its targets share.
    for (const ScanErrors& scan : scans) {
      if (scan.errors.empty()) continue;
      for (const Errors& errors : scan.errors) single.add(errors[component]);
      shared.add(sum_of(scan, component) / std::sqrt(static_cast<double>(scan.errors.size())));
    }
    CAPTURE(kComponents[component], single.count(), single.mean(), single.mean_square(),
            shared.count(), shared.mean(), shared.mean_square());
    check_standard_normal(single, 0.01);
    check_standard_normal(shared, 0.05);
  }
}

TEST_CASE("errors of one target are not the same from scan to scan") {
  const std::string name = GENERATE("standing", "bends");
  const std::size_t radar = GENERATE(kClusters, kGprRadar);
  CAPTURE(name, radar);
  const auto scans = errors_over_seeds(name, radar);
  for (std::size_t component = 0; component < kComponents.size(); ++component) {
    std::map<std::pair<double, double>, Moments> places;
    for (const ScanErrors& scan : scans) {
      for (std::size_t i = 0; i < scan.errors.size(); ++i) {
        places[scan.places[i]].add(scan.errors[i][component]);
      }
    }
    Moments repeated;
    for (const auto& [place, moments] : places) {
      repeated.add(moments.mean() * std::sqrt(moments.count()));
    }
    CAPTURE(kComponents[component], repeated.count(), repeated.mean(), repeated.mean_square());
    check_standard_normal(repeated, 0.1);
  }
}

TEST_CASE("errors of range, azimuth and Doppler are independent") {
  const std::string name = GENERATE("bends", "standing");
  const std::size_t radar = GENERATE(kClusters, kGprRadar);
  CAPTURE(name, radar);
  Moments range_azimuth;
  Moments range_doppler;
  Moments azimuth_doppler;
  for (const ScanErrors& scan : errors_over_seeds(name, radar)) {
    for (const auto& [range, azimuth, doppler] : scan.errors) {
      range_azimuth.add(range * azimuth);
      range_doppler.add(range * doppler);
      azimuth_doppler.add(azimuth * doppler);
    }
  }
  const double bound = 4.5 / std::sqrt(range_azimuth.count()) + 0.005;
  CHECK(std::abs(range_azimuth.mean()) < bound);
  CHECK(std::abs(range_doppler.mean()) < bound);
  CHECK(std::abs(azimuth_doppler.mean()) < bound);
}

TEST_CASE("a shared Doppler error is in all targets of a scan and changes slowly") {
  Moments squares;
  Moments products;
  double previous = 0.0;
  for (const ScanErrors& scan : errors_over_seeds("bends", kGprRadar, kSharedMps)) {
    const auto count = static_cast<double>(scan.errors.size());
    if (scan.errors.size() < 20) continue;
    const double mean_mps = kReportedMps * sum_of(scan, 2) / count;
    squares.add(mean_mps * mean_mps - kReportedMps * kReportedMps / count);
    products.add(mean_mps * previous);
    previous = mean_mps;
  }
  CHECK(std::sqrt(squares.mean()) == Approx(kSharedMps).epsilon(0.1));
  CHECK(products.mean() / squares.mean() == Approx(0.7).margin(0.1));
}
