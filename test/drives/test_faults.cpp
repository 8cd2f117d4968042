// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <vector>

#include <catch2/catch.hpp>

#include "test/faults/fault_matrix.hpp"

using namespace cremed;
using namespace cremed::test;

TEST_CASE("Simulated drives: each fault, what each source makes of it", "[long]") {
  std::vector<FaultDrive> drives;
  for (const auto* name : {"straight", "bends", "stop-and-go", "city", "roundabout", "u-turn"}) {
    drives.push_back(simulated_fault_drive(name, 20.0));
  }
  check_faults(drives,
               // The yaw rate follows a knock that passes the gate at low speed, until positions of
               // the other radars correct it; x is wrong too until the radar is excluded.
               {{"knocked", {.odometry_beyond = 0.04, .ratio = 1.4}}}, true);
}

TEST_CASE("Each fault of a short drive leaves estimates") {
  const FaultDrive drive = simulated_fault_drive("bends", 3.0);
  for (const FaultCase& fault : fault_cases(drive)) {
    CAPTURE(fault.kind, fault.of);
    const FaultOutcome outcome = run(drive, fault);
    CHECK(std::any_of(outcome.sources.begin(), outcome.sources.end(),
                      [](const SourceVerdict& source) { return source.estimates != 0; }));
  }
}
