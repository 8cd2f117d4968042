// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Decodes frames for dbc_test: "ID#DATA" lines on standard input become "ID#DATA NAME=VALUE ...",
// with the names and units of config/*.dbc. With "commands" and without input: encodes given
// values.
#include <cmath>
#include <iomanip>
#include <iostream>
#include <numbers>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cremed/can_decoders/ars408_commands.hpp"
#include "cremed/can_decoders/ars408_signals.hpp"
#include "cremed/can_decoders/bosch_gpr.hpp"
#include "test/can_decoders/hex_frame.hpp"

namespace {

using namespace cremed;

using Signals = std::vector<std::pair<std::string, double>>;
using Bytes = std::span<const std::uint8_t>;

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

double code(auto value) { return static_cast<double>(value); }

Signals signals(const Ars408ClusterStatus& m) {
  return {{"NofClustersNear", m.near_count},
          {"NofClustersFar", m.far_count},
          {"MeasCounter", m.counter},
          {"InterfaceVersion", m.interface_version}};
}

Signals signals(const Ars408ObjectStatus& m) {
  return {{"NofObjects", m.count},
          {"MeasCounter", m.counter},
          {"InterfaceVersion", m.interface_version}};
}

Signals signals(const Ars408General& m) {
  return {{"ID", m.id},           {"DistLong", m.x_m},   {"DistLat", m.y_m},
          {"VrelLong", m.vx_mps}, {"VrelLat", m.vy_mps}, {"DynProp", code(m.dyn_prop)},
          {"RCS", m.rcs_dbm2}};
}

Signals with_rms(const Ars408RmsCodes& rms, Signals others) {
  others.insert(others.end(), {{"DistLong_rms", rms.x},
                               {"DistLat_rms", rms.y},
                               {"VrelLong_rms", rms.vx},
                               {"VrelLat_rms", rms.vy}});
  return others;
}

Signals signals(const Ars408ClusterQuality& m) {
  return with_rms(m.rms, {{"ID", m.id},
                          {"Pdh0", m.false_alarm_code},
                          {"InvalidState", code(m.invalid_state)},
                          {"AmbigState", code(m.ambiguity)}});
}

Signals signals(const Ars408ObjectQuality& m) {
  return with_rms(m.rms, {{"ID", m.id},
                          {"ArelLong_rms", m.ax_rms_code},
                          {"ArelLat_rms", m.ay_rms_code},
                          {"Orientation_rms", m.orientation_rms_code},
                          {"ProbOfExist", m.existence_code},
                          {"MeasState", code(m.measurement_state)}});
}

Signals signals(const Ars408RadarState& m) {
  return {{"NVMReadStatus", m.nvm_read},
          {"NVMwriteStatus", m.nvm_written},
          {"MaxDistanceCfg", m.max_distance_m},
          {"Persistent_Error", m.persistent_error},
          {"Interference", m.interference},
          {"Temperature_Error", m.temperature_error},
          {"Temporary_Error", m.temporary_error},
          {"Voltage_Error", m.voltage_error},
          {"RadarPowerCfg", m.power_code},
          {"SortIndex", m.sort_code},
          {"SensorID", m.sensor_id},
          {"MotionRxState", (m.speed_missing ? 1 : 0) + (m.yaw_rate_missing ? 2 : 0)},
          {"SendExtInfoCfg", m.sends_extended},
          {"SendQualityCfg", m.sends_quality},
          {"OutputTypeCfg", m.output_code},
          {"CtrlRelayCfg", m.relay_control},
          {"RCS_Threshold", m.rcs_threshold_code}};
}

Signals signals(const Ars408Version& m) {
  return {{"MajorRelease", m.major_release},
          {"MinorRelease", m.minor_release},
          {"PatchLevel", m.patch_level},
          {"ExtendedRange", m.extended_range},
          {"CountryCode", m.power_restricted}};
}

/// The limits have the names of the file without their criterion.
Signals signals(const Ars408FilterState& m) {
  const double unit = m.criterion == Ars408Criterion::azimuth_rad ? kDegPerRad : 1.0;
  return {{"Type", m.for_objects},
          {"Index", code(m.criterion)},
          {"Active", m.active},
          {"Min", m.min * unit},
          {"Max", m.max * unit}};
}

Signals signals(const BoschGprTargetA& m) {
  return {{"AMessage", m.is_a},      {"ID", m.id},
          {"dr", m.range_m},         {"vr", m.radial_velocity_mps},
          {"dbPower", m.power_dbm2}, {"phi", m.azimuth_rad},
          {"measured", m.measured},  {"MC", m.counter}};
}

Signals signals(const BoschGprTargetB& m) {
  return {{"AMessage", m.is_a},          {"ID", m.id},
          {"phiSdv", m.azimuth_std_rad}, {"vrSdv", m.radial_velocity_std_mps},
          {"drSdv", m.range_std_m},      {"pExist", m.existence},
          {"timeSinceMeas", m.age_s},    {"MC", m.counter}};
}

Signals signals(const BoschGprInfo& m) {
  return {{"SensorType", m.sensor_type},
          {"HWTemperature", m.temperature_degc},
          {"SensorBlind", m.blind},
          {"SWFail", m.software_failure},
          {"HWFail", m.hardware_failure},
          {"CANFail", m.can_failure},
          {"ConfigFail", m.configuration_failure},
          {"DiagMode", m.diagnostic_mode},
          {"DTC", m.trouble_code},
          {"DTCOrderId", m.trouble_order},
          {"SensorNotSafe", m.not_safe},
          {"MC", m.counter}};
}

template <typename Message>
Signals signals(const std::optional<Message>& message) {
  return message ? signals(*message) : Signals();
}

Signals signals_of_ars408(std::uint32_t id, Bytes bytes) {
  switch (Ars408Message{static_cast<std::uint16_t>(ars408_base_id(id))}) {
    case Ars408Message::radar_state:
      return signals(decode_ars408_radar_state(bytes));
    case Ars408Message::filter_state:
      return signals(decode_ars408_filter_state(bytes));
    case Ars408Message::cluster_status:
      return signals(decode_ars408_cluster_status(bytes));
    case Ars408Message::object_status:
      return signals(decode_ars408_object_status(bytes));
    case Ars408Message::object_general:
      return signals(decode_ars408_object_general(bytes));
    case Ars408Message::object_quality:
      return signals(decode_ars408_object_quality(bytes));
    case Ars408Message::version:
      return signals(ars408_signals::decoded<Ars408Version>(Ars408Message::version, bytes));
    case Ars408Message::cluster_general:
      return signals(decode_ars408_cluster_general(bytes));
    case Ars408Message::cluster_quality:
      return signals(decode_ars408_cluster_quality(bytes));
    default:
      return {};
  }
}

Signals gpr_signals(std::uint32_t id, Bytes bytes) {
  const BoschGprOptions options;
  if (id == options.info_id) {
    return signals(decode_bosch_gpr_info(bytes));
  }
  return (id - options.base_id) % 2 == 0 ? signals(decode_bosch_gpr_target_a(bytes))
                                         : signals(decode_bosch_gpr_target_b(bytes));
}

void print(const std::string& frame, const Signals& signals) {
  std::cout << frame << std::setprecision(12);
  for (const auto& [name, value] : signals) {
    std::cout << ' ' << name << '=' << value;
  }
  std::cout << '\n';
}

void print(const CanFrame& frame, const Signals& signals) {
  std::ostringstream text;
  text << std::hex << std::uppercase << std::setfill('0') << std::setw(3) << frame.id << '#';
  for (const std::uint8_t byte : test::bytes_of(frame)) {
    text << std::setw(2) << int{byte};
  }
  print(text.str(), signals);
}

/// Each setting alone: its value and its valid bit.
void print_configurations() {
  for (const int value : {0, 1, 2}) {
    const auto small = static_cast<std::uint8_t>(value);
    const bool flag = value != 0;
    const double number = value;
    print(encode_ars408_command(0, {.max_distance_m = 196.0 + 2.0 * value}),
          {{"MaxDistance", 196.0 + 2.0 * value}, {"MaxDistance_valid", 1}, {"SensorID_valid", 0}});
    print(encode_ars408_command(0, {.sensor_id = small}),
          {{"SensorID", number}, {"SensorID_valid", 1}, {"MaxDistance_valid", 0}});
    print(encode_ars408_command(0, {.power_code = small}),
          {{"RadarPower", number}, {"RadarPower_valid", 1}, {"OutputType_valid", 0}});
    print(encode_ars408_command(0, {.output_code = small}),
          {{"OutputType", number}, {"OutputType_valid", 1}, {"RadarPower_valid", 0}});
    print(encode_ars408_command(0, {.sends_quality = flag}),
          {{"SendQuality", flag}, {"SendQuality_valid", 1}, {"SendExtInfo_valid", 0}});
    print(encode_ars408_command(0, {.sends_extended = flag}),
          {{"SendExtInfo", flag}, {"SendExtInfo_valid", 1}, {"SendQuality_valid", 0}});
    print(encode_ars408_command(0, {.sort_code = small}),
          {{"SortIndex", number}, {"SortIndex_valid", 1}, {"StoreInNVM_valid", 0}});
    print(encode_ars408_command(0, {.store = flag}),
          {{"StoreInNVM", flag}, {"StoreInNVM_valid", 1}, {"SortIndex_valid", 0}});
    print(encode_ars408_command(0, {.relay_control = flag}),
          {{"CtrlRelay", flag}, {"CtrlRelay_valid", 1}, {"RCS_Threshold_valid", 0}});
    print(encode_ars408_command(0, {.rcs_threshold_code = small}),
          {{"RCS_Threshold", number}, {"RCS_Threshold_valid", 1}, {"CtrlRelay_valid", 0}});
  }
}

void print_filters() {
  for (std::uint8_t i = 0; i < 16; ++i) {
    const auto criterion = Ars408Criterion{i};
    // Decoded values, rounded to the frame's resolution.
    const CanFrame sent = encode_ars408_filter(0, {i % 2 == 0, i % 3 == 0, criterion, 0.2, 3.0});
    Signals values = signals(decode_ars408_filter_state(test::bytes_of(sent)));
    values.emplace_back("Valid", 1);
    print(sent, values);
  }
}

void print_motions() {
  for (const double speed_mps : {-1.5, 0.0, 33.34}) {
    print(encode_ars408_speed(0, speed_mps), {{"Speed", std::abs(speed_mps)},
                                              {"SpeedDirection", speed_mps < 0.0   ? 2
                                                                 : speed_mps > 0.0 ? 1
                                                                                   : 0}});
  }
  for (const double yaw_rate_degps : {-90.25, 0.0, 12.34}) {
    print(encode_ars408_yaw_rate(0, yaw_rate_degps / kDegPerRad), {{"YawRate", yaw_rate_degps}});
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc == 2 ? argv[1] : "";
  if (what == "commands") {
    print_configurations();
    print_filters();
    print_motions();
    return 0;
  }
  for (std::string line; std::getline(std::cin, line);) {
    const CanFrame frame = test::hex_frame(line);
    const auto bytes = test::bytes_of(frame);
    print(line,
          what == "bosch_gpr" ? gpr_signals(frame.id, bytes) : signals_of_ars408(frame.id, bytes));
  }
  return 0;
}
