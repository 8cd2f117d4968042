// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdio>
#include <string>

#include "test/faults/fault_verdict.hpp"

namespace cremed::test {

inline constexpr const char* kColumns =
    R"(Columns, counted from the beginning of the fault: what does not hold (B rows beyond, O the pose
since the start beyond, U a guilty radar unnamed, I an innocent one named, R no recovery, C a wrong
cause named); shares of the time in % with the odometry ok (or standing still), ambiguous, lost,
predicted, initialising, and without; usable rows, those beyond 5 sigma in %, the largest error in
sigma, also of the pose since the start; largest error of the pose after 10 s in m and degrees;
radars named: "*" guilty, time excluded / in doubt in %, first after s, bits of the doubts; seconds
from the fault's end to a second that is right.
)";

inline std::string figures_header() {
  char text[160];
  std::snprintf(text, sizeof text,
                "%-59s|  ok amb los pre ini non | rows beyond   sigma  odom |     m    deg | named",
                "     drive       case");
  return text;
}

inline void append(std::string& line, const char* format, auto... values) {
  char text[160];
  std::snprintf(text, sizeof text, format, values...);
  line += text;
}

inline void append_radar(std::string& line, const std::string& name, bool is_guilty,
                         const RadarFigures& radar) {
  append(line, " %s%s %.0f/%.0f", name.c_str(), is_guilty ? "*" : "", 100.0 * radar.left_out,
         100.0 * radar.doubted);
  if (radar.named_after_s) append(line, " at %.1f (%x)", *radar.named_after_s, radar.doubts);
  constexpr std::array kCauses{"",  "scale", "sign",      "upside down", "yaw",
                               "x", "late",  "exchanged", "offset"};
  for (std::size_t i = 0; i < radar.causes.size(); ++i) {
    if (radar.causes[i] != 0) append(line, " %d %s", radar.causes[i], kCauses[i]);
  }
  if (radar.cause.value != 0.0) append(line, " %.3f", radar.cause.value);
}

inline std::string figures_line(const FaultDrive& drive, const FaultCase& fault,
                                const DriveFigures& figures) {
  const auto percent = [&](OdometryStatus status) { return 100.0 * figures.status_share(status); };
  std::string line;
  append(line, "%-4s %-11s ", verdict_of(fault, figures).failures().c_str(), drive.name.c_str());
  append(line, "%-20s %-21s", fault.kind.c_str(), fault.of.c_str());
  append(line, "|%4.0f %3.0f %3.0f %3.0f %3.0f %3.0f ",
         percent(OdometryStatus::ok) + percent(OdometryStatus::standing_still),
         percent(OdometryStatus::ambiguous), percent(OdometryStatus::lost),
         percent(OdometryStatus::predicted), percent(OdometryStatus::initialising),
         100.0 * figures.status.back());
  append(line, "|%5zu %5.1f %7.1f %5.1f ", figures.usable, 100.0 * figures.beyond_share(),
         figures.worst_sigmas, figures.odom_sigmas);
  if (figures.windows > 0) {
    append(line, "|%6.1f %6.2f |", figures.window_m, figures.window_deg);
  } else {
    line += "|     -      - |";
  }
  for (std::size_t i = 0; i < figures.radars.size(); ++i) {
    const bool is_guilty = (fault.guilty >> i & 1U) != 0;
    if (is_guilty || figures.radars[i].named_after_s) {
      append_radar(line, drive.radars[i].name, is_guilty, figures.radars[i]);
    }
  }
  if (fault.ends()) {
    line += figures.recovery_s ? "" : " | never";
    if (figures.recovery_s) append(line, " | %.1f", *figures.recovery_s);
  }
  if (fault.kind == "none") {
    line += " | available";
    for (const RadarFigures& radar : figures.radars) {
      append(line, " %.1f", 100.0 * radar.availability);
    }
  }
  return line;
}

}  // namespace cremed::test
