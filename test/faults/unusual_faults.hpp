// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "cremed/estimator/scan/degrees.hpp"
#include "test/faults/cluster_faults.hpp"
#include "test/faults/fault_case.hpp"
#include "tools/simulate/random.hpp"

namespace cremed::test {

/// Faults that come slowly, that two or all radars share, or that no value of the configuration
/// describes. Two thresholds were set by them: kMaxShareOfOthersLate, and the limit of
/// agree_on_slip(). All radars are ARS408.
class UnusualFaults {
 public:
  explicit UnusualFaults(const FaultDrive& drive) : drive_(drive) {}

  [[nodiscard]] std::vector<FaultCase> all() {
    cases_.clear();
    for (std::size_t radar = 0; radar < drive_.radars.size(); ++radar) {
      add_slow(radar);
      add_loose(radar);
      add_views(radar);
      add_positions(radar);
      add_clutter(radar);
    }
    add_pairs();
    add_common();
    add_only_sides();
    return std::move(cases_);
  }

 private:
  static constexpr std::uint64_t kStream = 917;
  static constexpr double kDriftS = 10.0;

  /// From 0 at the fault's begin to 1 kDriftS later.
  static double grown(double time_s) { return std::clamp(time_s / kDriftS, 0.0, 1.0); }

  /// Velocities have steps of 0.25 m/s: what grows in all of them would jump by that.
  static void unround(Ars408General& cluster, Random& random) {
    cluster.vx_mps += random.uniform(-0.125, 0.125);
  }

  FaultCase& add(std::string kind, std::size_t radar) {
    const FaultTime from_4s{drive_.start_us() + 4'000'000, kNever};
    FaultCase& added =
        cases_.emplace_back(FaultCase{std::move(kind), drive_.radars[radar].name, from_4s});
    added.guilty = 1U << radar;
    added.may_be_learned = true;
    return added;
  }

  /// `change(cluster, seconds)`
  template <typename Change>
  void change(std::string kind, std::size_t radar, Change change) {
    FaultCase& added = add(std::move(kind), radar);
    added.changes = true;
    added.put_in = [radar, change](const FaultDrive& d, FaultTime t) {
      return with_changed_clusters(d.frames, t, only(radar), change);
    };
  }

  void add_slow(std::size_t radar) {
    for (const double factor : {0.85, 0.95, 1.05, 1.15}) {
      change(fault_kind("scale drifts to %.2f", factor), radar,
             [factor, random = Random(1, kStream)](Ars408General& cluster, double time_s) mutable {
               unround(cluster, random);
               const double now = 1.0 + (factor - 1.0) * grown(time_s);
               cluster.vx_mps *= now;
               cluster.vy_mps *= now;
             });
    }
    for (const double deg : {-8.0, 3.0}) {
      change(fault_kind("mount drifts by %.0f deg", deg), radar,
             [deg](Ars408General& cluster, double time_s) {
               turn(cluster, -deg * kRadPerDeg * grown(time_s));
             });
    }
    change("offset drifts to 0.6 m/s", radar,
           [random = Random(1, kStream)](Ars408General& cluster, double time_s) mutable {
             unround(cluster, random);
             add_doppler(cluster, 0.6 * grown(time_s));
           });
  }

  void add_loose(std::size_t radar) {
    for (const auto& [deg, hz] : {std::pair{1.0, 2.0}, {3.0, 0.5}, {3.0, 3.0}}) {
      change(fault_kind("loose, %.0f deg", deg) + fault_kind(" at %.1f Hz", hz), radar,
             [deg = deg, hz = hz](Ars408General& cluster, double s) {
               turn(cluster, deg * kRadPerDeg * std::sin(2.0 * std::numbers::pi * hz * s));
             });
    }
  }

  template <typename IsSeen>
  void see(const std::string& kind, std::size_t radar, IsSeen is_seen) {
    FaultCase& added = add(kind, radar);
    added.guilty = 0;
    added.put_in = [radar, is_seen](const FaultDrive& d, FaultTime t) {
      return with_targets(d.frames, t, [&](const Ars408General& cluster, std::size_t of) {
        return of != radar || is_seen(cluster);
      });
    };
  }

  /// What is left is right: nobody is at fault.
  void add_views(std::size_t radar) {
    see("left half blind", radar, [](const Ars408General& each) { return each.y_m < 0.0; });
    see("sees 15 m", radar, [](const Ars408General& each) { return each.x_m < 15.0; });
    see("sees beyond 20 m", radar, [](const Ars408General& each) { return each.x_m > 20.0; });
  }

  void add_positions(std::size_t radar) {
    change("azimuth bent", radar, [](Ars408General& cluster, double) {
      const double azimuth = std::atan2(cluster.y_m, cluster.x_m);
      turn(cluster, 0.03 * std::sin(3.0 * azimuth));
    });
    change("range 0.7 m longer", radar, [](Ars408General& cluster, double) {
      const double range_m = std::hypot(cluster.x_m, cluster.y_m);
      cluster.x_m *= 1.0 + 0.7 / range_m;
      cluster.y_m *= 1.0 + 0.7 / range_m;
    });
  }

  /// Things fixed to the vehicle, or spray, take the place of a share of the targets.
  void add_clutter(std::size_t radar) {
    for (const double share : {0.3, 0.7}) {
      change(fault_kind("trailer, %.1f of the targets", share), radar,
             [share, random = Random(1, kStream)](Ars408General& cluster, double) mutable {
               if (!random.chance(share)) return;
               cluster.x_m = std::round(random.uniform(1.0, 5.0));
               cluster.y_m = std::round(random.uniform(-1.2, 1.2));
               cluster.vx_mps = cluster.vy_mps = 0.0;
             });
      change(fault_kind("spray, %.1f of the targets", share), radar,
             [share, random = Random(1, kStream)](Ars408General& cluster, double) mutable {
               if (!random.chance(share)) return;
               cluster.x_m = random.uniform(1.0, 8.0);
               cluster.y_m = random.uniform(-0.5, 0.5) * cluster.x_m;
               cluster.vx_mps *= random.uniform(0.3, 0.9);
               cluster.vy_mps *= random.uniform(0.3, 0.9);
             });
    }
  }

  /// Two radars that look along the vehicle's axis have the same error.
  void add_pairs() {
    for (std::size_t one = 0; one < drive_.radars.size(); ++one) {
      for (std::size_t other = one + 1; other < drive_.radars.size(); ++other) {
        if (drive_.is_side(one) || drive_.is_side(other)) continue;
        for (const int ms : {100, 200, 300, 500}) {
          add_pair(fault_kind("two late %g ms", ms), one, other, FaultKind::late,
                   put(with_late_stamps, one, 1000 * ms), put(with_late_stamps, other, 1000 * ms));
        }
        for (const double deg : {-5.0, 5.0, 10.0}) {
          add_pair(fault_kind("two turned %g deg", deg), one, other, FaultKind::mount_yaw,
                   put(with_knocked_mount, one, deg * kRadPerDeg),
                   put(with_knocked_mount, other, deg * kRadPerDeg));
        }
      }
    }
  }

  void add_pair(const std::string& kind, std::size_t one, std::size_t other, FaultKind cause,
                const PutIn& of_one, const PutIn& of_other) {
    FaultCase& added = add(kind, one);
    added.of += "+" + drive_.radars[other].name;
    added.guilty |= 1U << other;
    added.cause = cause;
    added.put_in = both(of_one, of_other);
  }

  /// All radars have the same error: scales from the start, from 4 s or for 8 s, mounts in the
  /// configuration.
  void add_common() {
    for (const double factor : {0.95, 1.05}) {
      const std::string kind = fault_kind("all scale %g", factor);
      const PutIn put_in = put(with_scaled_doppler, every_radar, factor);
      add_to_all(kind + " from 4 s", FaultKind::scale).put_in = put_in;
      FaultCase& from_start = add_to_all(kind, FaultKind::scale);
      from_start.time.from_us = drive_.start_us();
      from_start.put_in = put_in;
      FaultCase& ended = add_to_all(kind + " for 8 s", FaultKind::scale);
      ended.time.until_us = ended.time.from_us + 8'000'000;
      ended.put_in = put_in;
    }
    for (const double deg : {-5.0, -2.0, 1.5, 3.0, 10.0}) {
      FaultCase& added = add_to_all(fault_kind("all mounts %g deg off", deg), FaultKind::mount_yaw);
      added.time.from_us = drive_.start_us();
      added.configure = [deg](FaultCase::Radars& radars) {
        for (RadarConfiguration& radar : radars) {
          radar.ego_motion.vehicle_from_radar.yaw_rad += deg * kRadPerDeg;
        }
      };
    }
  }

  FaultCase& add_to_all(const std::string& kind, FaultKind cause) {
    FaultCase& added = add(kind, 0);
    added.of = "";
    added.guilty = (1U << drive_.radars.size()) - 1U;
    added.cause = cause;
    return added;
  }

  void add_only_sides() {
    const FaultTime eight_s{drive_.start_us() + 4'000'000, drive_.start_us() + 12'000'000};
    cases_.push_back({"only sides for 8 s", "", eight_s, only_sides});
  }

  const FaultDrive& drive_;
  std::vector<FaultCase> cases_;
};

}  // namespace cremed::test
