// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "test/faults/parked_drive.hpp"

namespace cremed::test {

/// A vehicle that stands for 6 s and then starts itself with 0.1 to 2 m/s^2, up to 8 m/s: forward
/// or back, straight on or in a turn, beside parked lorries, among cars that pass and behind one
/// that starts before it, or beside a tram that is on its way. All by `seed`.
class StartDrive {
 public:
  explicit StartDrive(std::uint64_t seed)
      : random_(seed, kFaultStream),
        acceleration_mps2_(0.1 * std::pow(20.0, random_.uniform())),
        beside_(random_.index(3)),
        layout_{random_.index(3), random_.chance(0.5)},
        is_reverse_(random_.chance(0.2)),
        curvature_1pm_(random_.chance(0.5) ? random_.uniform(-0.15, 0.15) : 0.0) {
    options_.seed = seed;
    options_.duration_s = 20.0;
  }

  [[nodiscard]] FaultDrive drive() {
    Scenario scene = scenario("standing");
    scene.course = course();
    const bool has_cars = beside_ == 1;
    scene.traffic = {.oncoming_interval_s = has_cars ? 4.0 : 0.0,
                     .same_way_interval_s = has_cars ? 8.0 : 0.0,
                     .leader = has_cars && !is_reverse_};
    if (beside_ == 0) scene.traffic.departures = parked_lorries();
    if (beside_ == 2) scene.traffic.departures = {tram()};
    const Drive start = cremed::test::drive(scene, layout_.radars(), options_);
    return {name(), start.radars, start.frames, truth_of(start), TruthNoise()};
  }

 private:
  [[nodiscard]] CoursePlan course() const {
    const double seconds = std::clamp(8.0 / acceleration_mps2_, 1.0, 14.0);
    const double duration_s = std::round(seconds / VehicleCourse::kStepS) * VehicleCourse::kStepS;
    const double speed_mps = (is_reverse_ ? -1.0 : 1.0) * acceleration_mps2_ * duration_s;
    return {0.0,
            {{ParkedDrive::kDepartureS, 0.0, curvature_1pm_},
             {duration_s, speed_mps, 0.5 * curvature_1pm_},
             {20.0, speed_mps, 0.0}},
            curvature_1pm_};
  }

  [[nodiscard]] static std::vector<Departure> parked_lorries() {
    std::vector<Departure> result;
    for (const double left_m : {-4.0, 4.0}) {
      for (int place = -2; place <= 2; ++place) {
        result.push_back({{14.0 * place, left_m, 0.0}, 10.0, 2.5, 1.5, 1e6, 1.0, 15.0});
      }
    }
    return result;
  }

  [[nodiscard]] Departure tram() const {
    return {{-60.0, 5.0, 0.0}, 40.0, 2.5, layout_.kind == 2 ? 4.0 : 1.5, 3.0, 1.0, 12.0};
  }

  [[nodiscard]] std::string name() const {
    constexpr std::array<const char*, 3> kBeside{"lorries", "cars", "tram"};
    char text[96];
    std::snprintf(text, sizeof text, "own-start %llu %s %.2f m/s2%s %s",
                  static_cast<unsigned long long>(options_.seed), kBeside.at(beside_),
                  acceleration_mps2_, is_reverse_ ? " back" : "", layout_.name().c_str());
    return text;
  }

  Random random_;
  double acceleration_mps2_;
  std::size_t beside_;
  RadarLayout layout_;
  bool is_reverse_;
  double curvature_1pm_;
  SimulationOptions options_;
};

}  // namespace cremed::test
