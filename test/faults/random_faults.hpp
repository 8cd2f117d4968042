// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "cremed/estimator/scan/degrees.hpp"
#include "test/faults/cluster_faults.hpp"
#include "test/faults/fault_case.hpp"
#include "tools/simulate/random.hpp"

namespace cremed::test {

/// Faults of one radar or two, of any place, kind, size and time: what no threshold was set on. All
/// radars are ARS408.
class RandomFaults {
 public:
  static constexpr std::uint64_t kStream = 911;

  RandomFaults(const FaultDrive& drive, std::uint64_t seed)
      : drive_(drive), random_(seed, kStream) {}

  [[nodiscard]] std::vector<FaultCase> draw(std::size_t count) {
    constexpr double kTwoShare = 0.2;
    std::vector<FaultCase> cases;
    for (std::size_t i = 0; i < count; ++i) {
      const FaultTime time = draw_time();
      const std::size_t first = random_.index(drive_.radars.size());
      FaultCase fault = of(first, time);
      const std::size_t others = drive_.radars.size() - 1;
      if (random_.chance(kTwoShare) && others > 0) {
        const FaultCase second = of((first + 1 + random_.index(others)) % (others + 1), time);
        fault = pair_of(fault, second);
      }
      cases.push_back(fault);
    }
    return cases;
  }

 private:
  FaultTime draw_time() {
    const std::int64_t start_us = drive_.start_us();
    if (random_.chance(0.4)) return {start_us, kNever};
    const std::int64_t from_us = start_us + std::llround(random_.uniform(3e6, 12e6));
    if (random_.chance(0.5)) return {from_us, kNever};
    return {from_us, from_us + std::llround(random_.uniform(2e6, 5e6))};
  }

  double either_sign(double low, double high) {
    return random_.uniform(low, high) * (random_.chance(0.5) ? 1.0 : -1.0);
  }

  static FaultCase pair_of(const FaultCase& first, const FaultCase& second) {
    FaultCase result = first;
    result.kind += " & " + second.kind;
    result.of += "+" + second.of;
    result.guilty |= second.guilty;
    result.others_guilty = second.guilty;
    result.cause_of_others = second.cause;
    result.may_be_learned = first.may_be_learned || second.may_be_learned;
    result.put_in = both(first.put_in, second.put_in);
    return result;
  }

  /// What is drawn for one radar. `may_be_learned`: see FaultCase.
  struct Fault {
    std::string kind;
    FaultKind cause;
    bool may_be_learned;
    PutIn put_in;
  };

  FaultCase of(std::size_t radar, FaultTime time) {
    constexpr std::array kKinds{
        &RandomFaults::scale,        &RandomFaults::offset, &RandomFaults::turned,
        &RandomFaults::range,        &RandomFaults::late,   &RandomFaults::clock,
        &RandomFaults::noise,        &RandomFaults::ghosts, &RandomFaults::loss,
        &RandomFaults::silence,      &RandomFaults::stuck,  &RandomFaults::upside_down,
        &RandomFaults::repeated_scan};
    const Fault drawn = (this->*kKinds[random_.index(kKinds.size())])(radar);
    FaultCase fault{drawn.kind, drive_.radars[radar].name, time, drawn.put_in};
    fault.guilty = 1U << radar;
    fault.cause = drawn.cause;
    fault.may_be_learned = drawn.may_be_learned;
    return fault;
  }

  /// `change(cluster, random)` is applied to each cluster of a radar.
  template <typename Change>
  static PutIn clusters(std::size_t radar, Change change) {
    return [radar, change](const FaultDrive& d, FaultTime t) {
      Random random(1, kStream);
      return with_changed_clusters(d.frames, t, only(radar),
                                   [&](Ars408General& cluster) { change(cluster, random); });
    };
  }

  Fault scale(std::size_t radar) {
    const double factor = 1.0 + either_sign(0.02, 0.4);
    return {fault_kind("scale %.2f", factor), FaultKind::scale,
            drive_.is_side(radar) || std::abs(factor - 1.0) < 0.06,
            put(with_scaled_doppler, only(radar), factor)};
  }

  Fault offset(std::size_t radar) {
    const double mps = either_sign(0.05, 1.0);
    return {fault_kind("offset %.2f", mps), FaultKind::offset,
            drive_.is_side(radar) || std::abs(mps) < 0.4,
            clusters(radar, [mps](Ars408General& cluster, Random&) { add_doppler(cluster, mps); })};
  }

  Fault turned(std::size_t radar) {
    const double deg = either_sign(1.0, 20.0);
    return {fault_kind("turned %.1f", deg), FaultKind::mount_yaw,
            drive_.is_side(radar) || std::abs(deg) < 5.0,
            put(with_knocked_mount, radar, deg * kRadPerDeg)};
  }

  Fault range(std::size_t radar) {
    const double factor = 1.0 + either_sign(0.02, 0.2);
    return {fault_kind("range %.2f", factor), FaultKind::unknown, true,
            clusters(radar, [factor](Ars408General& cluster, Random&) {
              cluster.x_m *= factor;
              cluster.y_m *= factor;
            })};
  }

  Fault late(std::size_t radar) {
    const double ms = random_.uniform(50.0, 800.0);
    return {fault_kind("late %.0f", ms), FaultKind::late, drive_.is_side(radar) || ms < 300.0,
            put(with_late_stamps, radar, std::llround(1e3 * ms))};
  }

  Fault clock(std::size_t radar) {
    const double ms = either_sign(50.0, 450.0);
    return {fault_kind("clock %+.0f", ms), FaultKind::late,
            drive_.is_side(radar) || std::abs(ms) < 300.0,
            put(with_clock_offset, radar, std::llround(1e3 * ms))};
  }

  Fault noise(std::size_t radar) {
    const double std_mps = random_.uniform(0.2, 2.0);
    return {fault_kind("noise %.1f", std_mps), FaultKind::unknown, true,
            clusters(radar, [std_mps](Ars408General& cluster, Random& random) {
              add_doppler(cluster, std_mps * random.normal());
            })};
  }

  Fault ghosts(std::size_t radar) {
    const double share = random_.uniform(0.2, 0.95);
    return {fault_kind("ghosts %.2f", share), FaultKind::unknown, true,
            clusters(radar, [share](Ars408General& cluster, Random& random) {
              if (!random.chance(share)) return;
              cluster.x_m = random.uniform(2.0, 60.0);
              cluster.y_m = random.uniform(-1.0, 1.0) * cluster.x_m;
              cluster.vx_mps = random.uniform(-20.0, 20.0);
              cluster.vy_mps = 0.0;
            })};
  }

  Fault loss(std::size_t radar) {
    const double share = random_.uniform(0.05, 0.7);
    return {fault_kind("loss %.2f", share), FaultKind::unknown, true,
            [radar, share](const FaultDrive& d, FaultTime t) {
              Random random(1, kStream);
              Frames frames = d.frames;
              std::erase_if(frames, [&](const CanFrame& frame) {
                return frame.interface == radar && t.has(frame) && random.chance(share);
              });
              return frames;
            }};
  }

  Fault silence(std::size_t radar) {
    return {"silent", FaultKind::unknown, true, put(with_silence, only(radar))};
  }

  /// Doppler at zero, or of the wrong sign.
  Fault stuck(std::size_t radar) {
    const double factor = random_.chance(0.5) ? 0.0 : -1.0;
    return {fault_kind("times %.0f", factor), factor == 0.0 ? FaultKind::scale : FaultKind::sign,
            drive_.is_side(radar), put(with_scaled_doppler, only(radar), factor)};
  }

  Fault upside_down(std::size_t radar) {
    return {"upside down", FaultKind::upside_down, true, put(with_upside_down, radar)};
  }

  Fault repeated_scan(std::size_t radar) {
    return {"repeats", FaultKind::unknown, drive_.is_side(radar),
            [radar](const FaultDrive& d, FaultTime t) {
              Frames of_radar;
              Arrivals arrivals;
              for (const CanFrame& frame : d.frames) {
                if (frame.interface == radar) {
                  of_radar.push_back(frame);
                } else {
                  arrivals.add(frame.stamp_us, frame);
                }
              }
              for (const CanFrame& frame : with_repeated_scan(of_radar, t)) {
                arrivals.add(frame.stamp_us, frame);
              }
              return arrivals.in_order();
            }};
  }

  const FaultDrive& drive_;
  Random random_;
};

}  // namespace cremed::test
