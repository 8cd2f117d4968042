// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <utility>
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
      if (random_.chance(kTwoShare)) {
        const std::size_t others = drive_.radars.size() - 1;
        const FaultCase second = of((first + 1 + random_.index(others)) % (others + 1), time);
        fault = both(fault, second);
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

  static FaultCase both(const FaultCase& first, const FaultCase& second) {
    FaultCase result = first;
    result.kind += " & " + second.kind;
    result.of += "+" + second.of;
    result.guilty |= second.guilty;
    result.cause = FaultKind::unknown;
    result.may_be_learned = first.may_be_learned || second.may_be_learned;
    result.put_in = [first, second](const FaultDrive& drive, FaultTime time) {
      FaultDrive changed = drive;
      changed.frames = first.put_in(drive, time);
      return second.put_in(changed, time);
    };
    return result;
  }

  using ChangeCluster = std::function<void(Ars408General&)>;
  static std::function<Frames(const FaultDrive&, FaultTime)> clusters(std::size_t radar,
                                                                      const ChangeCluster& change) {
    return [radar, change](const FaultDrive& d, FaultTime t) {
      return with_changed_clusters(
          d.frames, t, [radar](std::size_t each) { return each == radar; }, change);
    };
  }

  FaultCase of(std::size_t radar, FaultTime time) {
    FaultCase fault{"", drive_.radars[radar].name, time};
    fault.guilty = 1U << radar;
    const auto set = [&](const char* name, double value, FaultKind cause, bool may_be_learned,
                         std::function<Frames(const FaultDrive&, FaultTime)> put_in) {
      char text[64];
      std::snprintf(text, sizeof text, name, value);
      fault.kind = text;
      fault.cause = cause;
      fault.may_be_learned = may_be_learned;
      fault.put_in = std::move(put_in);
    };
    const bool is_side = drive_.is_side(radar);
    switch (random_.index(13)) {
      case 0: {
        const double factor = 1.0 + either_sign(0.02, 0.4);
        set("scale %.2f", factor, FaultKind::scale, is_side || std::abs(factor - 1.0) < 0.06,
            [=](const FaultDrive& d, FaultTime t) {
              return with_scaled_doppler(
                  d.frames, t, [radar](std::size_t each) { return each == radar; }, factor);
            });
        break;
      }
      case 1: {
        const double mps = either_sign(0.05, 1.0);
        set("offset %.2f", mps, FaultKind::unknown, is_side || std::abs(mps) < 0.4,
            clusters(radar, [mps](Ars408General& c) {
              const double r = std::hypot(c.x_m, c.y_m);
              c.vx_mps += mps * c.x_m / r;
              c.vy_mps += mps * c.y_m / r;
            }));
        break;
      }
      case 2: {
        const double deg = either_sign(1.0, 20.0);
        set("turned %.1f", deg, FaultKind::mount_yaw, is_side || std::abs(deg) < 5.0,
            [=](const FaultDrive& d, FaultTime t) {
              return with_knocked_mount(d.frames, t, radar, deg * kRadPerDeg);
            });
        break;
      }
      case 3: {
        const double factor = 1.0 + either_sign(0.02, 0.2);
        set("range %.2f", factor, FaultKind::unknown, true,
            clusters(radar, [factor](Ars408General& c) {
              c.x_m *= factor;
              c.y_m *= factor;
            }));
        break;
      }
      case 4: {
        const double ms = random_.uniform(50.0, 800.0);
        set("late %.0f", ms, FaultKind::late, is_side || ms < 300.0,
            [=](const FaultDrive& d, FaultTime t) {
              return with_late_stamps(d.frames, t, radar, std::llround(1e3 * ms));
            });
        break;
      }
      case 5: {
        const double ms = either_sign(50.0, 450.0);
        set("clock %+.0f", ms, FaultKind::late, is_side || std::abs(ms) < 300.0,
            [=](const FaultDrive& d, FaultTime t) {
              return with_clock_offset(d.frames, t, radar, std::llround(1e3 * ms));
            });
        break;
      }
      case 6: {
        const double std_mps = random_.uniform(0.2, 2.0);
        set("noise %.1f", std_mps, FaultKind::unknown, true, [=](const FaultDrive& d, FaultTime t) {
          Random random(1, kStream);
          return clusters(radar, [&random, std_mps](Ars408General& c) {
            const double r = std::hypot(c.x_m, c.y_m);
            const double more = std_mps * random.normal();
            c.vx_mps += more * c.x_m / r;
            c.vy_mps += more * c.y_m / r;
          })(d, t);
        });
        break;
      }
      case 7: {
        const double share = random_.uniform(0.2, 0.95);
        set("ghosts %.2f", share, FaultKind::unknown, true, [=](const FaultDrive& d, FaultTime t) {
          Random random(1, kStream);
          return clusters(radar, [&random, share](Ars408General& c) {
            if (!random.chance(share)) return;
            c.x_m = random.uniform(2.0, 60.0);
            c.y_m = random.uniform(-1.0, 1.0) * c.x_m;
            c.vx_mps = random.uniform(-20.0, 20.0);
            c.vy_mps = 0.0;
          })(d, t);
        });
        break;
      }
      case 8: {
        const double share = random_.uniform(0.05, 0.7);
        set("loss %.2f", share, FaultKind::unknown, true, [=](const FaultDrive& d, FaultTime t) {
          Random random(1, kStream);
          Frames frames = d.frames;
          std::erase_if(frames, [&](const CanFrame& frame) {
            return frame.interface == radar && t.has(frame) && random.chance(share);
          });
          return frames;
        });
        break;
      }
      case 9:
        set("silent", 0.0, FaultKind::unknown, true, [=](const FaultDrive& d, FaultTime t) {
          return with_silence(d.frames, t, [radar](std::size_t each) { return each == radar; });
        });
        break;
      case 10: {
        const double factor = random_.chance(0.5) ? 0.0 : -1.0;
        set("times %.0f", factor, factor == 0.0 ? FaultKind::scale : FaultKind::sign, is_side,
            [=](const FaultDrive& d, FaultTime t) {
              return with_scaled_doppler(
                  d.frames, t, [radar](std::size_t each) { return each == radar; }, factor);
            });
        break;
      }
      case 11:
        set("upside down", 0.0, FaultKind::upside_down, true,
            [=](const FaultDrive& d, FaultTime t) { return with_upside_down(d.frames, t, radar); });
        break;
      default:
        set("repeats", 0.0, FaultKind::unknown, is_side, [=](const FaultDrive& d, FaultTime t) {
          Frames of_radar;
          Frames others;
          for (const CanFrame& frame : d.frames) {
            (frame.interface == radar ? of_radar : others).push_back(frame);
          }
          Arrivals arrivals;
          for (const CanFrame& f : with_repeated_scan(of_radar, t)) arrivals.add(f.stamp_us, f);
          for (const CanFrame& f : others) arrivals.add(f.stamp_us, f);
          return arrivals.in_order();
        });
    }
    return fault;
  }

  const FaultDrive& drive_;
  Random random_;
};

}  // namespace cremed::test
