// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <catch2/catch.hpp>

#include "test/faults/figures_line.hpp"
#include "test/faults/not_yet.hpp"
#include "test/faults/systematic_faults.hpp"

namespace cremed::test {

/// The demands of FaultVerdict on many drives, by kind of fault.
class SystematicMatrix {
 public:
  /// `not_yet`: the column of kNotYet for these drives.
  explicit SystematicMatrix(std::string_view NotYet::*not_yet) : not_yet_(not_yet) {}

  /// Those with `text` in their kind.
  void run_faults(const FaultDrive& drive, std::string_view text = "") {
    run(drive, SystematicFaults(drive).all(), text);
  }

  void run(const FaultDrive& drive, const std::vector<FaultCase>& faults, std::string_view text) {
    int found = 0;
    for (const FaultCase& fault : faults) {
      if (fault.kind == "none" || fault.kind.find(text) == std::string::npos) continue;
      add(fault.kind, drive, fault, judged(drive, fault));
      ++found;
    }
    REQUIRE(found > 0);
  }

  /// A drive without fault: nobody is named. A: a front radar is less available than
  /// `least_front_availability`; S: the odometry less usable than `least_usable`, as if it did not
  /// start.
  void run_healthy(const std::string& kind, const FaultDrive& drive,
                   double least_front_availability = 0.0, double least_usable = 0.0) {
    const FaultCase none{"none", "", {drive.start_us(), kNever}};
    const DriveFigures figures = judged(drive, none);
    add(kind, drive, none, figures);
    if (figures.status_share(OdometryStatus::ok) +
            figures.status_share(OdometryStatus::standing_still) <
        least_usable) {
      failures_[kind].insert('S');
    }
    for (std::size_t i = 0; i < drive.radars.size(); ++i) {
      const double front = std::cos(drive.radars[i].ego_motion.vehicle_from_radar.yaw_rad);
      if (front > 0.5 && figures.radars[i].availability < least_front_availability) {
        failures_[kind].insert('A');
      }
    }
  }

  /// Nothing fails but what kNotYet lists, and of each kind that it lists something does.
  void check() const {
    for (const auto& [kind, failures] : failures_) {
      const std::string found(failures.begin(), failures.end());
      const std::string_view listed = listed_of(kind);
      CAPTURE(kind, found, listed);
      CHECK(found.find_first_not_of(listed) == std::string::npos);
      // A kind that holds is to be deleted there.
      CHECK(found.empty() == listed.empty());
    }
  }

 private:
  void add(const std::string& kind, const FaultDrive& drive, const FaultCase& fault,
           const DriveFigures& figures) {
    std::printf("%s\n", figures_line(drive, fault, figures).c_str());
    const std::string found = verdict_of(fault, figures).failures();
    failures_[kind].insert(found.begin(), found.end());
  }

  [[nodiscard]] std::string_view listed_of(const std::string& kind) const {
    const auto* row = std::find_if(kNotYet.begin(), kNotYet.end(),
                                   [&](const NotYet& each) { return each.kind == kind; });
    return row == kNotYet.end() ? std::string_view() : row->*not_yet_;
  }

  std::string_view NotYet::*not_yet_;
  std::map<std::string, std::set<char>> failures_;
};

}  // namespace cremed::test
