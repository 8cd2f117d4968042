// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/table/robot_drive.hpp"

#include <array>

#include "cremed/can_decoders/bosch_gpr.hpp"
#include "daemon/source/candump.hpp"
#include "tools/line_stream.hpp"
#include "tools/simulate/simulation.hpp"

namespace cremed {
namespace {

/// In front of the axis of rotation.
constexpr Pose2 kMount{0.3, 0.0, 0.0};

/// The default, 20, is for cars; the campus has about 20 targets in view.
constexpr int kMinTargets = 8;

Configuration robot() {
  Configuration configuration;
  RadarConfiguration& radar = configuration.radars.emplace_back();
  radar.name = "front";
  radar.interface = "can0";
  radar.decoder = BoschGprOptions{};
  radar.ego_motion.vehicle_from_radar = kMount;
  configuration.odometry.filter.min_targets = kMinTargets;
  return configuration;
}

void write_log(Simulation& simulation, const std::string& path) {
  LineStream log(path);
  std::array<char, kMaxCandumpLine> line{};
  while (const auto frame = simulation.next()) {
    const auto length =
        format_candump_line(*frame, simulation.interfaces()[frame->interface], line);
    log.stream().write(line.data(), static_cast<std::streamsize>(length));
  }
  log.finish();
}

}  // namespace

RobotDrive::RobotDrive(std::uint64_t seed)
    : drive_{folder_.file("can.log"), folder_.file("truth.csv"), robot()} {
  Simulation simulation(*find_scenario("campus"), drive_.configuration.radars, {.seed = seed});
  LineStream truth(drive_.truth);
  simulation.write_truth(truth.stream());
  truth.finish();
  write_log(simulation, drive_.log);
}

}  // namespace cremed
