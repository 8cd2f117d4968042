// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Decodes frames for dbc_test: "ID#DATA" lines on standard input become "ID#DATA NAME=VALUE ...",
// with the names and units of config/*.dbc. With "commands" and without input: encodes given
// values.
#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <numbers>
#include <span>
#include <sstream>
#include <string>

#include "cremed/can_decoders/ars408_commands.hpp"
#include "cremed/can_decoders/ars408_signals.hpp"
#include "cremed/can_decoders/bosch_gpr_signals.hpp"
#include "test/can_decoders/hex_frame.hpp"
#include "test/can_decoders/signal_values.hpp"

namespace {

using namespace cremed;

using Bytes = std::span<const std::uint8_t>;
using test::NamedValues;
using test::values_of;

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

template <auto decode>
NamedValues told(Bytes bytes) {
  const auto message = decode(bytes);
  return message ? values_of(*message) : NamedValues();
}

/// With azimuths in degrees.
NamedValues filter_of(Bytes bytes) {
  Ars408FilterState filter = decode_ars408<Ars408FilterState>(bytes).value();
  if (filter.criterion == Ars408Criterion::azimuth_rad) {
    filter.min *= kDegPerRad;
    filter.max *= kDegPerRad;
  }
  return values_of(filter);
}

NamedValues ars408_signals_of(std::uint32_t id, Bytes bytes) {
  static const std::map<Ars408Message, NamedValues (*)(Bytes)> kMessages = {
      {Ars408Message::radar_state, told<decode_ars408<Ars408RadarState>>},
      {Ars408Message::filter_state, filter_of},
      {Ars408Message::cluster_status, told<decode_ars408<Ars408ClusterStatus>>},
      {Ars408Message::object_status, told<decode_ars408<Ars408ObjectStatus>>},
      {Ars408Message::object_general, told<decode_ars408<Ars408Object>>},
      {Ars408Message::object_quality, told<decode_ars408<Ars408ObjectQuality>>},
      {Ars408Message::version, told<decode_ars408<Ars408Version>>},
      {Ars408Message::cluster_general, told<decode_ars408<Ars408Cluster>>},
      {Ars408Message::cluster_quality, told<decode_ars408<Ars408ClusterQuality>>},
  };
  return kMessages.at(Ars408Message{static_cast<std::uint16_t>(ars408_base_id(id))})(bytes);
}

NamedValues gpr_signals_of(std::uint32_t id, Bytes bytes) {
  const BoschGprOptions options;
  if (id == options.info_id) {
    return told<decode_bosch_gpr<BoschGprInfo>>(bytes);
  }
  return (id - options.base_id) % 2 == 0 ? told<decode_bosch_gpr<BoschGprTargetA>>(bytes)
                                         : told<decode_bosch_gpr<BoschGprTargetB>>(bytes);
}

void print(const std::string& frame, const NamedValues& values) {
  std::cout << frame << std::setprecision(12);
  for (std::size_t i = 0; i < values.size(); ++i) {
    auto [name, value] = values[i];
    if (i + 1 < values.size() && values[i + 1].first == name) {
      value += 2.0 * values[++i].second;
    }
    std::cout << ' ' << name << '=' << value;
  }
  std::cout << '\n';
}

void print(const CanFrame& frame, const NamedValues& values) {
  std::ostringstream text;
  text << std::hex << std::uppercase << std::setfill('0') << std::setw(3) << frame.id << '#';
  for (const std::uint8_t byte : test::bytes_of(frame)) {
    text << std::setw(2) << int{byte};
  }
  print(text.str(), values);
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
    NamedValues values = filter_of(test::bytes_of(sent));
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
    print(line, what == "bosch_gpr" ? gpr_signals_of(frame.id, bytes)
                                    : ars408_signals_of(frame.id, bytes));
  }
  return 0;
}
