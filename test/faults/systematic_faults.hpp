// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cremed/estimator/scan/degrees.hpp"
#include "test/faults/cluster_faults.hpp"
#include "test/faults/fault_case.hpp"
#include "test/faults/truck_ahead.hpp"

namespace cremed::test {

/// The faults of a drive that stay the same for its whole time or from a moment on, so that each
/// radar by itself looks healthy: scales, signs, mounts, wiring and clocks. All radars are ARS408.
class SystematicFaults {
 public:
  explicit SystematicFaults(const FaultDrive& drive) : drive_(drive) {
    for (std::size_t i = 0; i < drive.radars.size(); ++i) {
      (drive.is_side(i) ? sides_ : ahead_).push_back(i);
    }
  }

  [[nodiscard]] std::vector<FaultCase> all() {
    cases_.clear();
    cases_.push_back({"none", "", always()});
    add_scales();
    add_signs_and_mounts();
    add_wiring();
    add_all_radars();
    add_clocks();
    add_learned();
    add_truck();
    return std::move(cases_);
  }

 private:
  using Radars = FaultCase::Radars;

  [[nodiscard]] std::int64_t at(double time_s) const {
    return drive_.start_us() + std::llround(time_s * 1e6);
  }
  [[nodiscard]] FaultTime always() const { return {drive_.start_us(), kNever}; }
  [[nodiscard]] FaultTime onwards() const { return {at(8.0), kNever}; }
  [[nodiscard]] FaultTime for_a_while() const { return {at(8.0), at(13.0)}; }

  /// Front, another one that looks along the vehicle's axis, and a lateral one.
  [[nodiscard]] std::size_t front() const { return ahead_.at(0); }
  [[nodiscard]] std::size_t second() const { return ahead_.at(1); }
  [[nodiscard]] std::vector<std::size_t> of_each_place() const {
    return {front(), second(), sides_.at(0)};
  }
  [[nodiscard]] static std::uint32_t bit(std::size_t radar) { return 1U << radar; }
  [[nodiscard]] std::uint32_t all_bits() const { return bit(drive_.radars.size()) - 1U; }
  [[nodiscard]] const std::string& name(std::size_t radar) const {
    return drive_.radars[radar].name;
  }

  FaultCase& add(std::string kind, std::size_t radar, FaultTime time, FaultKind cause) {
    cases_.push_back({std::move(kind), name(radar), time});
    cases_.back().guilty = bit(radar);
    cases_.back().cause = cause;
    return cases_.back();
  }

  FaultCase& configure(const std::string& kind, std::size_t radar, FaultKind cause,
                       const std::function<void(RadarConfiguration&)>& change) {
    FaultCase& added = add(kind, radar, always(), cause);
    added.configure = [radar, change](Radars& radars) { change(radars[radar]); };
    return added;
  }

  static void scale(RadarConfiguration& radar, double factor) {
    radar.ego_motion.correction.doppler_scale *= factor;
    radar.ego_motion.correction.doppler_offset_mps *= factor;
  }

  void add_scales() {
    for (const std::size_t radar : of_each_place()) {
      for (const double factor : {0.9, 0.95, 1.05, 1.1}) {
        configure(fault_kind("scale %.2f", factor), radar, FaultKind::scale,
                  [factor](RadarConfiguration& each) { scale(each, factor); })
            // Beside a radar that looks sideways the reflections of objects move along with the
            // vehicle, by a sixth of its speed and more: no test tells a tenth from that.
            .may_be_learned = std::abs(factor - 1.0) < 0.06 || drive_.is_side(radar);
      }
    }
    for (const double factor : {1.0, 0.7, 0.9, 1.1}) {
      add_scale_alone("alone, scale %.2f", factor, always());
    }
    for (const double factor : {0.7, 1.2}) {
      add_scale_alone("alone, scale %.2f from 8 s", factor, onwards());
    }
    for (const double yaw_rad : {0.05, 0.1, -0.1}) {
      add_turned_alone("alone, mount %g rad off", yaw_rad, always());
    }
    for (const double yaw_rad : {0.1, -0.1}) {
      add_turned_alone("alone, knocked by %g rad at 8 s", yaw_rad, onwards());
    }
  }

  FaultCase& add_alone(const std::string& kind, FaultTime time, FaultKind cause) {
    FaultCase& alone = add(kind, front(), time, cause);
    alone.configure = [radar = front()](Radars& radars) { radars = {radars[radar]}; };
    return alone;
  }

  void add_scale_alone(const char* kind, double factor, FaultTime time) {
    FaultCase& alone = add_alone(fault_kind(kind, factor), time, FaultKind::scale);
    if (factor == 1.0) alone.guilty = 0;
    alone.put_in = put(with_scaled_doppler, only(front()), factor);
  }

  void add_turned_alone(const char* kind, double yaw_rad, FaultTime time) {
    add_alone(fault_kind(kind, yaw_rad), time, FaultKind::mount_yaw).put_in =
        put(with_knocked_mount, front(), yaw_rad);
  }

  void add_signs_and_mounts() {
    for (const std::size_t radar : of_each_place()) {
      configure("sign flipped", radar, FaultKind::sign,
                [](RadarConfiguration& each) { scale(each, -1.0); });
    }
    for (const std::size_t radar : {front(), second()}) {
      add("upside down", radar, always(), FaultKind::upside_down).put_in =
          put(with_upside_down, radar);
    }
    for (const std::size_t radar : {front(), second()}) {
      for (const double yaw_deg : {3.0, 5.0, 10.0}) {
        configure(fault_kind("mount %g deg off", yaw_deg), radar, FaultKind::mount_yaw,
                  [yaw_deg](RadarConfiguration& each) {
                    each.ego_motion.vehicle_from_radar.yaw_rad += yaw_deg * kRadPerDeg;
                  })
            .may_be_learned = yaw_deg <= 5.0;
      }
    }
    configure("mount 2 m ahead", front(), FaultKind::mount_x,
              [](RadarConfiguration& each) { each.ego_motion.vehicle_from_radar.x_m += 2.0; });
    add("knocked at 8 s", front(), onwards(), FaultKind::mount_yaw).put_in =
        put(with_knocked_mount, front(), 0.1);
  }

  void swap(const std::string& kind, std::size_t a, std::size_t b) {
    std::vector<std::uint8_t> buses = straight_buses();
    std::swap(buses[a], buses[b]);
    connect(kind, name(a) + "+" + name(b), buses, bit(a) | bit(b));
  }

  [[nodiscard]] std::vector<std::uint8_t> straight_buses() const {
    std::vector<std::uint8_t> buses(drive_.radars.size());
    std::iota(buses.begin(), buses.end(), std::uint8_t{0});
    return buses;
  }

  void connect(const std::string& kind, const std::string& of,
               const std::vector<std::uint8_t>& buses, std::uint32_t guilty) {
    cases_.push_back({kind, of, always(), put(with_buses, buses)});
    cases_.back().guilty = guilty;
    cases_.back().cause = FaultKind::exchanged;
  }

  void add_wiring() {
    if (ahead_.size() > 2) {
      swap("buses swapped", ahead_[1], ahead_[2]);
    }
    swap("buses swapped", front(), second());
    swap("buses swapped", sides_.at(0), sides_.at(1));
    std::vector<std::uint8_t> rotated = straight_buses();
    std::rotate(rotated.begin(), rotated.begin() + 1, rotated.end());
    connect("buses rotated", "", rotated, all_bits());
  }

  void add_to_all(const std::string& kind, const PutIn& put_in) {
    for (const FaultTime time : {onwards(), for_a_while()}) {
      cases_.push_back(
          {kind + (time.until_us == kNever ? " from 8 s" : " for 5 s"), "", time, put_in});
      cases_.back().guilty = all_bits();
    }
  }

  void add_all_radars() {
    add_to_all("all flipped", put(with_scaled_doppler, every_radar, -1.0));
    add_to_all("all zero", put(with_scaled_doppler, every_radar, 0.0));
    add_to_all("all repeat", put(with_repeated_scan));
  }

  void add_clocks() {
    for (const std::size_t radar : {front(), second()}) {
      for (const std::int64_t late_ms : {100, 200, 300, 500}) {
        FaultCase& late =
            add("late " + std::to_string(late_ms) + " ms", radar, always(), FaultKind::late);
        late.may_be_learned = late_ms <= 300;
        late.put_in = put(with_late_stamps, radar, 1000 * late_ms);
      }
      for (const double ahead_s : {1.0, 0.3, -0.3}) {
        add(fault_kind("stamps %+.1f s ahead", ahead_s), radar, always(), FaultKind::late).put_in =
            put(with_clock_offset, radar, std::llround(ahead_s * 1e6));
      }
    }
    // As an overloaded computer does, or a USB adapter. Nobody is at fault.
    for (const int halt_ms : {50, 80}) {
      const PutIn halts = put(with_halts, 1'600'000, 1000 * halt_ms);
      cases_.push_back({fault_kind("halts of %.0f ms", halt_ms), "", onwards(), halts});
      cases_.push_back({fault_kind("alone, halts of %.0f ms", halt_ms), "", onwards(), halts});
      cases_.back().configure = [radar = front()](Radars& radars) { radars = {radars[radar]}; };
    }
    for (const double step_s : {0.1, 0.5, 1.0, -0.1, -0.5, -1.0}) {
      const auto step_us = std::llround(step_s * 1e6);
      cases_.push_back({fault_kind("clock step %+.1f s", step_s), "", onwards(),
                        put(with_clock_step, step_us), 0, step_us});
    }
  }

  /// Nearly the largest values and the smallest deviations that the state file accepts; of
  /// alternating sign, because their mean is not used.
  void add_learned() {
    constexpr double kStds = 4.9;
    constexpr double kLeastShare = 1e-3;
    const auto wrong = [](const LearnedError& unlearned, double sign) {
      return LearnedError{sign * kStds * unlearned.std, kLeastShare * unlearned.std};
    };
    std::vector<std::optional<LearnedErrors>> mounts;
    std::vector<std::optional<LearnedErrors>> scales;
    for (std::size_t i = 0; i < drive_.radars.size(); ++i) {
      const double sign = i % 2 == 0 ? 1.0 : -1.0;
      const LearnedErrors unlearned =
          unlearned_errors(OdometryOptions(), drive_.radars[i].ego_motion.vehicle_from_radar);
      mounts.push_back(LearnedErrors{wrong(unlearned.mount_yaw_rad, sign),
                                     {0.0, kLeastShare * unlearned.doppler_scale.std}});
      scales.push_back(LearnedErrors{{0.0, kLeastShare * unlearned.mount_yaw_rad.std},
                                     wrong(unlearned.doppler_scale, sign)});
    }
    cases_.push_back({"learned mounts wrong", "", always()});
    cases_.back().learned = mounts;
    cases_.back().guilty = all_bits();
    cases_.back().cause = FaultKind::mount_yaw;
    cases_.push_back({"learned scales wrong", "", always()});
    cases_.back().learned = scales;
    cases_.back().guilty = all_bits();
    cases_.back().cause = FaultKind::scale;
  }

  void add_truck() {
    const auto truck = [radar = front()](const FaultDrive& d, FaultTime t) {
      return TruckAhead(t, radar, 40).in(d.frames);
    };
    cases_.push_back({"truck ahead", name(front()), for_a_while(), truck});
    cases_.push_back({"alone, truck ahead", name(front()), for_a_while(), truck});
    cases_.back().configure = [radar = front()](Radars& radars) { radars = {radars[radar]}; };
  }

  const FaultDrive& drive_;
  std::vector<std::size_t> ahead_;  // Radars that look along the vehicle's axis.
  std::vector<std::size_t> sides_;  // Lateral ones.
  std::vector<FaultCase> cases_;
};

}  // namespace cremed::test
