// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <vector>

#include <catch2/catch.hpp>

#include "test/faults/fault_matrix.hpp"

using namespace cremed;
using namespace cremed::test;

TEST_CASE("Simulated drives: each fault, what each source makes of it") {
  std::vector<FaultDrive> drives;
  for (const auto* name : {"straight", "bends", "stop-and-go", "city", "roundabout", "u-turn"}) {
    drives.push_back(simulated_fault_drive(name, 20.0));
  }
  check_faults(drives,
               // The yaw rate follows a knock that passes the gate at low speed, until positions of
               // the other radars correct it; x is wrong too until the radar is excluded.
               {{"knocked", {.odometry_beyond = 0.04, .ratio = 1.4}}}, true);
}
