// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "cremed/can_decoders/bosch_gpr.hpp"
#include "cremed/can_decoders/can_frame.hpp"
#include "daemon/configuration/configuration.hpp"
#include "tools/simulate/can_bus.hpp"
#include "tools/simulate/radar_sender.hpp"
#include "tools/simulate/random.hpp"
#include "tools/simulate/scenario.hpp"
#include "tools/simulate/scene.hpp"

namespace cremed {

struct SimulationOptions {
  std::uint64_t seed = 1;
  double duration_s = 0.0;                        ///< 0: that of the scenario.
  std::int64_t start_us = 1'700'000'000'000'000;  ///< Unix epoch.

  // Errors that no radar reports, as large as on real drives (nuScenes), where ARS408 were compared
  // with wheel encoders: SharedErrorOptions has the figures.
  /// Of the velocity of all radars over that of the rear axle, which truth is of; slowly varying.
  double body_velocity_std_mps = 0.01;
  /// Of all Doppler of one radar; slowly varying.
  double doppler_offset_std_mps = 0.01;
  /// Of the factor on all Doppler of one radar that calibration leaves, constant. Front and rear
  /// radars of four drives, once 0.005 is put right, differ from the wheels by 0.0027 RMS.
  double doppler_scale_std = 0.0027;
  /// Of the difference between where a radar is and where the configuration says: constant,
  /// 0.3 degrees and 1 cm, what mounting with care leaves.
  double mount_yaw_std_rad = 0.005;
  double mount_position_std_m = 0.01;  ///< Of x and of y.

  /// ARS408s are told the vehicle's speed and yaw rate. See Ars408Sender.
  bool is_told_motion = true;
};

/// Without what a calibrated configuration does not know: mounts and Doppler scale are exact.
SimulationOptions exactly_mounted(SimulationOptions options);

/// Those of config/demo.toml: an ARS408 in front on can0, a Bosch GPR that looks back on can1.
std::vector<RadarConfiguration> default_radars();

/// A drive as the frames of all its buses, in the order of their stamps. The same arguments give
/// the same frames, on every machine. Radars are what the configuration says, rotation lead
/// and correction of Doppler included, but for the errors that the options ask for.
class Simulation {
 public:
  Simulation(const Scenario& scenario, const std::vector<RadarConfiguration>& radars,
             const SimulationOptions& options, const ScanObserver& observer = {});
  Simulation(const Simulation&) = delete;  // The radars refer to the scene.
  Simulation& operator=(const Simulation&) = delete;

  /// The next frame, its interface an index of interfaces(); none when the drive is over.
  std::optional<CanFrame> next();

  [[nodiscard]] const std::vector<std::string>& interfaces() const { return interfaces_; }
  [[nodiscard]] const Scene& scene() const { return scene_; }
  /// Where each radar really is in the vehicle frame.
  [[nodiscard]] const std::vector<Pose2>& mounts() const { return mounts_; }

  /// Pose of the rear axle every 10 ms as CSV: utime,x_m,y_m,yaw_rad.
  void write_truth(std::ostream& output) const;

 private:
  void attach(const std::vector<RadarConfiguration>& radars, const SenderSetup& setup);
  CanBus& bus_of(const std::string& interface);
  void attach_ars408(const Ars408Options& options, const SenderSetup& setup, CanBus& bus);
  void attach_gpr(const BoschGprOptions& options, const SenderSetup& setup, CanBus& bus);
  void attach_state(CanBus& bus, std::size_t radar, std::vector<CanFrame> frames);

  Scene scene_;
  double frame_loss_;
  Random loss_random_;
  std::vector<Pose2> mounts_;
  std::vector<std::string> interfaces_;
  std::vector<CanBus> buses_;
};

}  // namespace cremed
