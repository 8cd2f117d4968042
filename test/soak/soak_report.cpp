// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "test/soak/soak_report.hpp"

#include <cinttypes>
#include <cstdio>
#include <string_view>

#include "cremed/estimator/scan/degrees.hpp"

namespace cremed::soak {
namespace {

std::string names_of(FaultSet faults) {
  std::string names;
  for (const FaultRow& row : kFaults) {
    if ((faults >> static_cast<unsigned>(row.kind) & 1U) != 0) {
      names.append(names.empty() ? "" : ", ").append(row.name);
    }
  }
  return names.empty() ? "no fault" : names;
}

void print_row(std::string_view radar, std::string_view label, const Tally& tally) {
  if (tally.estimates != 0) {
    std::printf("%-8.*s %-22.*s %9" PRIu64 " %8" PRIu64 " %8" PRIu64 " %10.4f\n",
                static_cast<int>(radar.size()), radar.data(), static_cast<int>(label.size()),
                label.data(), tally.estimates, tally.beyond_x, tally.beyond_yaw,
                100.0 * share_within(tally));
  }
}

void print_radar(const std::string& radar, const RadarTallies& tallies) {
  Tally all;
  for (std::size_t i = 0; i < kScenarios.size(); ++i) {
    print_row(radar, kScenarios[i], tallies.by_scenario[i]);
    all += tallies.by_scenario[i];
  }
  print_row(radar, "all", all);
  constexpr std::array<std::string_view, 4> kClasses{"|a| below 1 m/s^2", "|a| below 2 m/s^2",
                                                     "|a| below 3 m/s^2", "|a| above"};
  for (std::size_t i = 0; i < kClasses.size(); ++i) {
    print_row(radar, kClasses[i], tallies.by_acceleration[i]);
  }
  print_row(radar, "with no fault", tallies.without_fault);
  for (std::size_t i = 0; i < kFaults.size(); ++i) {
    print_row(radar, kFaults[i].name, tallies.by_fault[i]);
  }
}

}  // namespace

double share_within(const Tally& tally) {
  return 1.0 - static_cast<double>(tally.beyond) / static_cast<double>(tally.estimates);
}

Tally total(const EstimateChecker& checker) {
  Tally all;
  for (const RadarTallies& tallies : checker.tallies()) {
    for (const Tally& tally : tallies.by_scenario) {
      all += tally;
    }
  }
  return all;
}

void print(const Found& found, const RadarNames& radars) {
  const std::string_view name = kViolationNames[static_cast<std::size_t>(found.violation)];
  const EgoMotion& m = found.motion;
  std::printf("VIOLATION %s, %.3f s into the drive: %.*s: %s, utime %" PRId64 " - %" PRId64
              ", x %g m, yaw %g rad\n",
              radars[found.radar].c_str(), found.drive_s, static_cast<int>(name.size()),
              name.data(), std::string(to_string(m.status)).c_str(), m.utime_start_us, m.utime_us,
              m.motion.x(), m.motion.z());
}

void print(const Comparison& c, const RadarNames& radars) {
  std::printf(
      "beyond %.0f sigma: %s %s %.3f s: x %+.1f sigma (of %.1f mm), yaw %+.1f (of %.3f "
      "deg) over %.3f s; %.1f m/s, %+.1f m/s^2, %d targets; %s\n",
      kMaxSigmas, radars[c.radar].c_str(), std::string(kScenarios[c.scenario]).c_str(), c.drive_s,
      c.x_error_sigma, 1e3 * c.x_sigma_m, c.yaw_error_sigma, kDegPerRad * c.yaw_sigma_rad, c.span_s,
      c.speed_mps, c.acceleration_mps2, c.targets, names_of(c.faults).c_str());
}

void print_tallies(const EstimateChecker& checker, const RadarNames& radars) {
  std::printf("%-8s %-22s %9s %8s %8s %10s\n", "radar", "estimates of", "number", "beyond x", "yaw",
              "within %");
  for (std::size_t i = 0; i < kSources; ++i) {
    print_radar(radars[i], checker.tallies()[i]);
  }
}

void print_faults(const FaultInjector& source) {
  std::printf("injected:");
  for (const FaultRow& row : kFaults) {
    std::printf(" %s %" PRIu64 ";", std::string(row.name).c_str(), source.count(row.kind));
  }
  std::printf(" every stamp late by 0 to %.0f us\n", kStampJitterUs);
}

}  // namespace cremed::soak
