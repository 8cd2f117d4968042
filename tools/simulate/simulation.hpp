// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cremed/can_decoders/bosch_gpr.hpp"
#include "cremed/can_decoders/can_frame.hpp"
#include "daemon/configuration/configuration.hpp"
#include "tools/line_file.hpp"
#include "tools/simulate/can_bus.hpp"
#include "tools/simulate/radar_sender.hpp"
#include "tools/simulate/random.hpp"
#include "tools/simulate/scenario.hpp"
#include "tools/simulate/scene.hpp"
#include "tools/simulate/told_motion.hpp"

namespace cremed {

struct SimulationOptions {
  std::uint64_t seed = 1;
  double duration_s = 0.0;                        ///< 0: the scenario's.
  std::int64_t start_us = 1'700'000'000'000'000;  ///< Unix epoch.

  // Unreported errors, as large as on real drives (nuScenes), where ARS408 were compared with wheel
  // encoders: see SharedErrorOptions.
  /// Velocity of all radars relative to the rear axle, to which truth refers; slowly varying.
  double body_velocity_std_mps = 0.01;
  /// Offset of all Doppler of one radar; slowly varying.
  double doppler_offset_std_mps = 0.01;
  /// Constant factor on all Doppler of one radar after calibration. The front and rear radars of
  /// four drives, corrected by 0.005, differ from the wheels by 0.0027 RMS.
  double doppler_scale_std = 0.0027;
  /// Difference of the true from the configured mount: constant, 0.3 degrees and 1 cm, as after
  /// careful mounting.
  double mount_yaw_std_rad = 0.005;
  double mount_position_std_m = 0.01;  ///< Of x and of y.

  /// ARS408s receive the vehicle's speed and yaw rate. See Ars408Sender.
  bool is_told_motion = true;

  /// Its bus sends them for the daemon too, if it has an interface: [vehicle] of the configuration.
  VehicleConfiguration vehicle{};
};

/// Radars of config/demo.toml: an ARS408 in front on can0, a Bosch GPR facing backwards on can1.
std::vector<RadarConfiguration> default_radars();

/// A drive as the frames of all buses, in the order of their stamps. Equal arguments give equal
/// frames on every machine. Radars follow the configuration, including rotation lead and correction
/// of Doppler, but for the errors in `options`.
class Simulation {
 public:
  Simulation(const Scenario& scenario, const std::vector<RadarConfiguration>& radars,
             const SimulationOptions& options, const ScanObserver& observer = {});
  Simulation(const Simulation&) = delete;  // The radars refer to the scene.
  Simulation& operator=(const Simulation&) = delete;

  /// The next frame, its interface an index of interfaces(); none at the end.
  std::optional<CanFrame> next();

  [[nodiscard]] const std::vector<std::string>& interfaces() const { return interfaces_; }
  [[nodiscard]] const Scene& scene() const { return scene_; }
  /// True mount of each radar.
  [[nodiscard]] const std::vector<Pose2>& mounts() const { return mounts_; }

  /// All frames that are left, as `candump -L` writes them; fewer if the file fails.
  void write_log(LineFile& log);
  /// Pose of the rear axle every 10 ms as CSV: utime,x_m,y_m,yaw_rad.
  [[nodiscard]] std::string truth_csv() const;

 private:
  void attach(const std::vector<RadarConfiguration>& radars, const SenderSetup& setup);
  CanBus& bus_of(const std::string& interface);
  void attach_ars408(const Ars408Options& options, const SenderSetup& setup, CanBus& bus);
  void attach_gpr(const BoschGprOptions& options, const SenderSetup& setup, CanBus& bus);
  void attach_vehicle(const SimulationOptions& options);
  void attach_state(CanBus& bus, std::size_t radar, std::vector<CanFrame> frames);

  Scene scene_;
  VehicleBus vehicle_bus_;
  double frame_loss_;
  Random loss_random_;
  std::vector<Pose2> mounts_;
  std::vector<std::string> interfaces_;
  std::vector<CanBus> buses_;
};

}  // namespace cremed
