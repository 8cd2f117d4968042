// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/table/robot_drive.hpp"

#include "cremed/can_decoders/bosch_gpr.hpp"
#include "tools/line_file.hpp"
#include "tools/simulate/simulation.hpp"

namespace cremed {
namespace {

/// In front of the axis of rotation.
constexpr Pose2 kMount{0.3, 0.0, 0.0};

Configuration robot() {
  Configuration configuration;
  RadarConfiguration& radar = configuration.radars.emplace_back();
  radar.name = "front";
  radar.interface = "can0";
  radar.decoder = BoschGprOptions{};
  radar.ego_motion.vehicle_from_radar = kMount;
  return configuration;
}

}  // namespace

DriveToPair robot_drive(std::uint64_t seed, const TemporaryFolder& folder) {
  DriveToPair drive{folder.file("can.log"), folder.file("truth.csv"), robot()};
  Simulation simulation(*find_scenario("campus"), drive.configuration.radars, {.seed = seed});
  LineFile truth(drive.truth);
  truth.write(simulation.truth_csv());
  truth.finish();
  LineFile log(drive.log);
  simulation.write_log(log);
  log.finish();
  return drive;
}

}  // namespace cremed
