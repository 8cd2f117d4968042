// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "test/faults/fault_drive.hpp"
#include "test/faults/frame_faults.hpp"
#include "tools/simulate/random.hpp"

namespace cremed::test {

/// What departs beside the parked vehicle.
enum class Neighbour : std::uint8_t {
  train,   ///< Left, right or across ahead; the row of its targets does not end.
  convoy,  ///< Lorries in front, behind and beside, all at once.
  jam,     ///< Cars around, the foremost first.
};

inline constexpr std::array<std::pair<std::string_view, Neighbour>, 3> kNeighbours{
    {{"train", Neighbour::train}, {"convoy", Neighbour::convoy}, {"jam-starts", Neighbour::jam}}};

/// Radars of a vehicle: the demo's car with side radars; four corners as on RadarScenes' car; two
/// Bosch GPR. All targets of the ARS408s are used, or those that they call static.
struct RadarLayout {
  std::size_t kind;
  bool are_flags_used;

  [[nodiscard]] std::string name() const {
    constexpr std::array<const char*, 3> kNames{"car", "corners", "GPR"};
    return std::string(kNames.at(kind)) + (are_flags_used && kind != 2 ? " flags" : "");
  }

  [[nodiscard]] std::vector<RadarConfiguration> radars() const {
    std::vector<RadarConfiguration> result;
    if (kind == 0) result = four_radars();
    if (kind == 1) {
      result = {radar("right_front", "can0", {3.86, -0.7, -0.436}, Ars408Options{}),
                radar("left_front", "can1", {3.86, 0.7, 0.436}, Ars408Options{}),
                radar("right_side", "can2", {3.66, -0.87, -1.484}, Ars408Options{}),
                radar("left_side", "can3", {3.66, 0.87, 1.484}, Ars408Options{})};
    }
    if (kind == 2) {
      result = {radar("front", "can0", {3.6, 0.0, 0.0}, BoschGprOptions{}),
                radar("rear", "can1", {-0.9, 0.0, std::numbers::pi}, BoschGprOptions{})};
    }
    for (RadarConfiguration& each : result) {
      if (const auto* ars408 = each.decoder.as<Ars408Options>(); ars408 && !are_flags_used) {
        Ars408Options unflagged = *ars408;
        unflagged.keep_dyn_props = 0xFF;
        each.decoder = unflagged;
      }
    }
    return result;
  }
};

/// A vehicle that is parked for 16 s; after 6 s its neighbours depart, with 0.1 to 2 m/s^2 and 30
/// to 100 % of the targets. With half of the ARS408s all targets are used, with the others those
/// that they call static. All by `seed`.
class ParkedDrive {
 public:
  ParkedDrive(Neighbour neighbour, std::uint64_t seed)
      : neighbour_(neighbour),
        random_(seed, kFaultStream),
        acceleration_mps2_(0.1 * std::pow(20.0, random_.uniform())),
        share_(random_.uniform(0.3, 1.0)),
        side_(random_.index(3)),
        layout_{random_.index(3), random_.chance(0.5)} {
    options_.seed = seed;
    options_.duration_s = 16.0;
  }

  [[nodiscard]] FaultDrive drive() {
    Scenario scene = scenario("standing");
    scene.traffic = {.oncoming_interval_s = 0.0, .same_way_interval_s = 0.0, .leader = false};
    scene.traffic.departures = departures();
    scene.world = {.built_share = 0.0, .clutter_per_m = 1.0};
    scene.world.clutter_per_m = clutter_per_m(scene);
    const Drive parked = cremed::test::drive(scene, layout_.radars(), options_);
    return {name(count(parked).departing_share()), parked.radars, parked.frames, truth_of(parked),
            TruthNoise()};
  }

  static constexpr double kDepartureS = 6.0;

 private:
  static constexpr std::array<const char*, 3> kSides{"left", "right", "ahead"};

  /// Targets before the departure, without ghosts.
  struct TargetCount {
    double departing = 0.0;
    double fixed = 0.0;
    [[nodiscard]] double departing_share() const { return departing / (departing + fixed); }
  };

  [[nodiscard]] TargetCount count(const Drive& parked) const {
    TargetCount count;
    for (const ScanTruth& scan : parked.truths) {
      if (static_cast<double>(scan.stamp_us - options_.start_us) * 1e-6 > kDepartureS) break;
      for (const Echo& echo : scan.echoes) {
        count.departing += echo.kind == EchoKind::vehicle ? 1.0 : 0.0;
        count.fixed += echo.kind == EchoKind::fixed ? 1.0 : 0.0;
      }
    }
    return count;
  }

  /// With which that share of the targets departs, as far as the radars can send all of them.
  [[nodiscard]] double clutter_per_m(Scenario scene) const {
    constexpr double kMostPerM = 6.0;
    constexpr int kTrials = 3;
    SimulationOptions short_trial = options_;
    short_trial.duration_s = 1.0;
    for (int i = 0; i < kTrials; ++i) {
      const TargetCount found = count(cremed::test::drive(scene, layout_.radars(), short_trial));
      const double wanted = found.departing * (1.0 - share_) / share_;
      scene.world.clutter_per_m =
          std::min(kMostPerM, scene.world.clutter_per_m * wanted / std::max(1.0, found.fixed));
    }
    return scene.world.clutter_per_m;
  }

  [[nodiscard]] std::string name(double share) const {
    char text[96];
    std::snprintf(text, sizeof text, "%s %llu %s %.2f m/s2 %.0f%% %s",
                  kNeighbours.at(static_cast<std::size_t>(neighbour_)).first.data(),
                  static_cast<unsigned long long>(options_.seed),
                  neighbour_ == Neighbour::train ? kSides.at(side_) : "around", acceleration_mps2_,
                  100.0 * share, layout_.name().c_str());
    return text;
  }

  [[nodiscard]] std::vector<Departure> departures() {
    switch (neighbour_) {
      case Neighbour::train:
        return {train()};
      case Neighbour::convoy:
        return vehicles(10.0, 2.5, 14.0, 0.0);
      case Neighbour::jam:
        return vehicles(4.2, 1.6, 7.5, 0.5);
    }
    return {};
  }

  [[nodiscard]] Departure train() const {
    constexpr double kBesideM = 3.5;
    constexpr double kAheadM = 14.0;
    constexpr double kHalfLengthM = 150.0;
    const Pose2 tails[] = {{-kHalfLengthM, kBesideM + 1.5, 0.0},
                           {-kHalfLengthM, -kBesideM - 1.5, 0.0},
                           {kAheadM, -kHalfLengthM, 0.5 * std::numbers::pi}};
    return {tails[side_], 2.0 * kHalfLengthM, 3.0, spacing_m(),
            kDepartureS,  acceleration_mps2_, 15.0};
  }

  /// A Bosch GPR sends few targets, the nearest.
  [[nodiscard]] double spacing_m() const { return layout_.kind == 2 ? 4.0 : 1.5; }

  /// Three lanes of vehicles, all but our own place; each starts `delay_s` after the one before it.
  [[nodiscard]] std::vector<Departure> vehicles(double length_m, double width_m, double period_m,
                                                double delay_s) {
    constexpr double kLaneM = 3.5;
    constexpr int kPlaces = 4;
    std::vector<Departure> result;
    for (int lane = -1; lane <= 1; ++lane) {
      for (int place = -kPlaces; place <= kPlaces; ++place) {
        const double tail_m = period_m * place + random_.uniform(-0.5, 0.5);
        const double start_s =
            kDepartureS + delay_s * (kPlaces - place) + random_.uniform(0.0, 0.3);
        if (lane == 0 && place == 0) continue;
        result.push_back({{tail_m, kLaneM * lane, 0.0},
                          length_m,
                          width_m,
                          spacing_m(),
                          start_s,
                          acceleration_mps2_ * random_.uniform(0.8, 1.25),
                          15.0});
      }
    }
    return result;
  }

  Neighbour neighbour_;
  Random random_;
  double acceleration_mps2_;
  double share_;  // Of the targets, that departs.
  std::size_t side_;
  RadarLayout layout_;
  SimulationOptions options_;
};

}  // namespace cremed::test
