// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulate/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include <spdlog/fmt/fmt.h>

#include "daemon/source/candump.hpp"
#include "tools/simulate/ars408_encoder.hpp"
#include "tools/simulate/ars408_sender.hpp"
#include "tools/simulate/bosch_gpr_encoder.hpp"
#include "tools/simulate/bosch_gpr_sender.hpp"
#include "tools/simulate/vehicle_sender.hpp"

namespace cremed {
namespace {

constexpr std::uint64_t kLossStream = 3;
/// First random streams of the radars; the radar's index is added.
constexpr std::uint64_t kMountStream = 512;
constexpr std::uint64_t kDopplerScaleStream = 768;
/// Random streams of the vehicle's sensors as the daemon hears them.
constexpr std::uint64_t kVehicleStream = 1024;
/// Constant errors of what the vehicle sends, beside those of VehicleBus: as large as wheels and
/// gyro of two cars have against their map-based poses (nuScenes).
constexpr double kVehicleScaleStd = 0.003;
constexpr double kVehicleYawRateBiasStdRadps = 0.0004;
constexpr double kArs408CycleUs = 72'000.0;
constexpr double kGprBusShare = 0.24;
constexpr std::int64_t kStatePeriodUs = 1'000'000;

double asked_duration_s(const Scenario& scenario, const SimulationOptions& options) {
  return options.duration_s > 0.0 ? options.duration_s : scenario.duration_s;
}

/// An ARS408 list takes most of its cycle; radars that share a bus must send less. How real ones do
/// that is unknown; here they share what is left of 90 % of the bus evenly.
std::size_t ars408_targets(const std::vector<RadarConfiguration>& radars,
                           const RadarConfiguration& radar) {
  double share = 0.9;
  int sharing = 0;
  for (const RadarConfiguration& other : radars) {
    if (other.interface != radar.interface) continue;
    if (other.decoder.as<BoschGprOptions>() != nullptr) {
      share -= kGprBusShare;
    } else {
      ++sharing;
    }
  }
  const auto target_us = static_cast<double>(frame_time_us(8) + frame_time_us(7));
  const auto room =
      static_cast<std::size_t>(std::max(0.0, share) * kArs408CycleUs / (sharing * target_us));
  const bool objects = radar.decoder.as<Ars408Options>()->output == Ars408Output::objects;
  return std::min(room, objects ? Ars408Sender::kMaxObjects : Ars408Sender::kMaxClusters);
}

/// As the daemon expects it.
Ars408RadarState radar_state(const Ars408Options& options, bool is_told_motion) {
  Ars408RadarState state;
  state.nvm_read = true;
  state.max_distance_m = options.model == Ars408Model::ars404_21 ? kArs404MaxRangeM : 200.0;
  state.sort_code = 1;
  state.sensor_id = options.sensor_id;
  state.sends_quality = true;
  state.output_code = options.output == Ars408Output::objects ? 1 : 2;
  state.speed_missing = !is_told_motion;
  state.yaw_rate_missing = !is_told_motion;
  return state;
}

/// A constant error of one standard deviation with random sign, so that a few drives have the
/// configured variance, unlike a few Gaussian draws.
double constant_error(Random& random, double std) { return random.uniform() < 0.5 ? -std : std; }

Pose2 real_mount(const Pose2& stated, const SimulationOptions& options, std::size_t radar) {
  Random random(options.seed, kMountStream + radar);
  Pose2 real = stated;
  real.yaw_rad += constant_error(random, options.mount_yaw_std_rad);
  real.x_m += constant_error(random, options.mount_position_std_m);
  real.y_m += constant_error(random, options.mount_position_std_m);
  return real;
}

/// The inverse of the configured correction, times the drawn errors.
DopplerErrors doppler_errors(const DetectionCorrection& correction,
                             const SimulationOptions& options, std::size_t radar) {
  Random random(options.seed, kDopplerScaleStream + radar);
  return {(1.0 + constant_error(random, options.doppler_scale_std)) / correction.doppler_scale,
          correction.doppler_offset_mps, options.doppler_offset_std_mps};
}

RadarConfiguration radar_at(const std::string& name, const std::string& interface,
                            const Pose2& vehicle_from_radar) {
  RadarConfiguration radar;
  radar.name = name;
  radar.interface = interface;
  radar.ego_motion.vehicle_from_radar = vehicle_from_radar;
  return radar;
}

}  // namespace

std::vector<RadarConfiguration> default_radars() {
  RadarConfiguration front = radar_at("front", "can0", {3.6, 0.0, 0.0});
  front.decoder = Ars408Options{};
  front.ego_motion.correction.rotation_lead_s = kArs408RotationLeadS;
  RadarConfiguration rear = radar_at("rear", "can1", {-0.9, 0.0, std::numbers::pi});
  rear.decoder = BoschGprOptions{};
  return {front, rear};
}

Simulation::Simulation(const Scenario& scenario, const std::vector<RadarConfiguration>& radars,
                       const SimulationOptions& options, const ScanObserver& observer)
    : scene_(scenario, asked_duration_s(scenario, options), options.start_us, options.seed,
             options.body_velocity_std_mps),
      vehicle_bus_(scene_.course(), Random(options.seed, kVehicleStream),
                   Random(options.seed, kVehicleStream + 1)),
      frame_loss_(scenario.faults.frame_loss),
      loss_random_(options.seed, kLossStream) {
  for (std::size_t i = 0; i < radars.size(); ++i) {
    const EgoMotionOptions& stated = radars[i].ego_motion;
    mounts_.push_back(real_mount(stated.vehicle_from_radar, options, i));
    attach(radars, {.radar = i,
                    .vehicle_from_radar = mounts_.back(),
                    .stated_mount = stated.vehicle_from_radar,
                    .is_told_motion = options.is_told_motion,
                    .correction = stated.correction,
                    .seed = options.seed,
                    .doppler = doppler_errors(stated.correction, options, i),
                    .faults = scenario.faults,
                    .observer = observer});
  }
  if (!options.vehicle.interface.empty()) {
    attach_vehicle(options);
  }
}

void Simulation::attach(const std::vector<RadarConfiguration>& radars, const SenderSetup& setup) {
  const RadarConfiguration& radar = radars[setup.radar];
  SenderSetup limited = setup;
  CanBus& bus = bus_of(radar.interface);
  if (const auto* ars408 = radar.decoder.as<Ars408Options>()) {
    limited.max_targets = ars408_targets(radars, radar);
    attach_ars408(*ars408, limited, bus);
  } else if (const auto* gpr = radar.decoder.as<BoschGprOptions>()) {
    limited.max_targets = kBoschGprSlots;
    attach_gpr(*gpr, limited, bus);
  } else {
    throw std::invalid_argument(radar.name + ": there is no simulation of type " +
                                std::string(radar.decoder.family().type));
  }
}

CanBus& Simulation::bus_of(const std::string& interface) {
  const auto found = std::ranges::find(interfaces_, interface);
  if (found != interfaces_.end()) {
    return buses_[static_cast<std::size_t>(found - interfaces_.begin())];
  }
  interfaces_.push_back(interface);
  return buses_.emplace_back(static_cast<std::uint8_t>(buses_.size()));
}

void Simulation::attach_ars408(const Ars408Options& options, const SenderSetup& setup,
                               CanBus& bus) {
  bus.attach(std::make_unique<Ars408Sender>(options, scene_, setup));
  attach_state(bus, setup.radar,
               {encode_ars408(options.sensor_id, radar_state(options, setup.is_told_motion))});
  attach_state(bus, setup.radar, {encode_ars408(options.sensor_id, Ars408Version{4, 30, 2})});
}

void Simulation::attach_gpr(const BoschGprOptions& options, const SenderSetup& setup, CanBus& bus) {
  bus.attach(std::make_unique<BoschGprSender>(options, scene_, setup));
  std::vector<CanFrame> infos;
  BoschGprInfo info;
  info.temperature_degc = 40;
  for (info.counter = 0; info.counter < 4; ++info.counter) {
    infos.push_back(encode_bosch_gpr_info(options.info_id, info));
  }
  attach_state(bus, setup.radar, std::move(infos));
}

void Simulation::attach_vehicle(const SimulationOptions& options) {
  Random random(options.seed, kVehicleStream + 2);
  const VehicleErrors errors{1.0 + constant_error(random, kVehicleScaleStd),
                             1.0 + constant_error(random, kVehicleScaleStd),
                             constant_error(random, kVehicleYawRateBiasStdRadps)};
  bus_of(options.vehicle.interface)
      .attach(std::make_unique<VehicleSender>(vehicle_bus_, errors, options.vehicle,
                                              scene_.start_us(), scene_.end_us()));
}

/// Once a second, not a multiple of the cycle: some state frames fall inside lists.
void Simulation::attach_state(CanBus& bus, std::size_t radar, std::vector<CanFrame> frames) {
  const std::int64_t first_us =
      scene_.start_us() + 130'000 + 137'000 * static_cast<std::int64_t>(radar);
  bus.attach(std::make_unique<PeriodicSender>(std::move(frames), first_us, kStatePeriodUs,
                                              scene_.end_us()));
}

std::optional<CanFrame> Simulation::next() {
  while (true) {
    const auto earliest = std::ranges::min_element(buses_, {}, &CanBus::next_stamp_us);
    if (earliest == buses_.end() || earliest->next_stamp_us() == FrameRequest::kNeverUs) {
      return std::nullopt;
    }
    const CanFrame frame = earliest->transmit();
    if (!loss_random_.chance(frame_loss_)) return frame;
  }
}

void Simulation::write_log(LineFile& log) {
  while (const auto frame = next()) {
    if (!log.write(candump_line(*frame, interfaces()[frame->interface]))) return;
  }
}

std::string Simulation::truth_csv() const {
  std::string csv = "utime,x_m,y_m,yaw_rad\n";
  const std::int64_t step_us = std::llround(VehicleCourse::kStepS * 1e6);
  std::int64_t stamp_us = scene_.start_us();
  for (const VehicleState& state : scene_.course().steps()) {
    csv += fmt::format("{},{:.9f},{:.9f},{:.12f}\n", stamp_us, state.pose.x_m, state.pose.y_m,
                       state.pose.yaw_rad);
    if (stamp_us >= scene_.end_us()) break;
    stamp_us += step_us;
  }
  return csv;
}

}  // namespace cremed
