// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <string_view>

#include "cremed/can_decoders/ars408.hpp"
#include "cremed/can_decoders/ars408_signals.hpp"
#include "cremed/can_decoders/radar_family.hpp"

namespace cremed {
namespace {

constexpr std::array<std::string_view, 2> kOutputs = {"clusters", "objects"};
constexpr std::uint8_t kSensors = 8;
constexpr std::string_view kInvertAzimuth = "invert_azimuth";

/// A foreign frame with one of these identifiers changes a setting or gives a wrong motion. 0x008
/// and 0x010 (relay) are harmless.
constexpr std::array<std::uint32_t, 6> kCommands = {0x200, 0x202, 0x300, 0x301, 0x400, 0x401};

std::uint32_t id_of(Ars408Message message, std::uint8_t sensor) {
  return ars408_id(static_cast<std::uint32_t>(message), sensor);
}

template <Ars408Model model>
constexpr std::string_view kName = "ARS408";
template <>
constexpr std::string_view kName<Ars408Model::ars404_21> = "ARS404";

template <Ars408Model model>
RadarSettings read(OptionReader& reader) {
  Ars408Options options{.model = model};
  reader.integer("sensor_id", options.sensor_id, 0, kSensors - 1);
  if (const auto output = reader.choice("output", kOutputs)) {
    options.output = static_cast<Ars408Output>(*output);
  }
  reader.bits("keep_invalid_states", options.keep_invalid_states, 31);
  std::uint32_t keep_dyn_props = options.keep_dyn_props;
  reader.bits("keep_dyn_props", keep_dyn_props, 7);
  options.keep_dyn_props = static_cast<std::uint8_t>(keep_dyn_props);
  reader.integer("min_existence_code", options.min_existence_code, 0, 7);
  reader.boolean(kInvertAzimuth, options.invert_azimuth);
  reader.boolean("motion_feedback", options.motion_feedback);
  return options;
}

std::unique_ptr<RadarDecoder> make_decoder(const Ars408Options& options) {
  return std::make_unique<Ars408Decoder>(options);
}

IdSet sent_ids(const Ars408Options& options) {
  IdSet ids;
  for (const Ars408MessageRow& row : kArs408Messages) {
    ids.set(id_of(row.message, options.sensor_id));
  }
  return ids;
}

IdSet obeyed_ids(const Ars408Options& options) {
  IdSet ids;
  for (const std::uint32_t id : kCommands) {
    ids.set(ars408_id(id, options.sensor_id));
  }
  return ids;
}

double rotation_lead_s(const Ars408Options& options) {
  return options.output == Ars408Output::clusters ? kArs408RotationLeadS : 0.0;
}

template <Ars408Model model>
std::string label(const Ars408Options& options) {
  return std::string(kName<model>) + " " + std::to_string(options.sensor_id);
}

template <Ars408Model model>
std::string describe(const Ars408Options& options) {
  return "an " + std::string(kName<model>) + " with sensor id " + std::to_string(options.sensor_id);
}

std::string key(const Ars408Options& options) {
  return "sensor_id = " + std::to_string(options.sensor_id);
}

/// The content is checked too: a GPR that loses a frame can match in identifier and length.
bool has_state(const BusTraffic& bus, const IdSet& ids, std::uint8_t sensor) {
  const std::uint32_t id = id_of(Ars408Message::radar_state, sensor);
  const IdTraffic& traffic = bus.ids[id];
  return ids[id] && traffic.length == traffic.payload.size() &&
         traffic.shortest_gap_us >= kArs408ShortestStateGapUs &&
         decode_ars408<Ars408RadarState>(traffic.payload)->sensor_id == sensor;
}

/// One periodic message with the right length is enough to recognise a sensor.
bool is_on(const BusTraffic& bus, const IdSet& ids, std::uint8_t sensor) {
  const auto has = [&](Ars408Message message, std::uint8_t length) {
    const std::uint32_t id = id_of(message, sensor);
    return ids[id] && bus.ids[id].length == length;
  };
  return has_state(bus, ids, sensor) || has(Ars408Message::cluster_status, 5) ||
         has(Ars408Message::object_status, 4);
}

std::vector<RadarSettings> recognise(const BusTraffic& bus, IdSet& unexplained) {
  std::vector<RadarSettings> radars;
  for (std::uint8_t sensor = 0; sensor < kSensors; ++sensor) {
    const Ars408Options options{.sensor_id = sensor};
    if (is_on(bus, unexplained, sensor)) {
      unexplained &= ~sent_ids(options);
      radars.emplace_back(options);
    }
  }
  return radars;
}

template <Ars408Model model>
constexpr RadarFamily row(std::string_view type, const RadarFamily* sends_like = nullptr,
                          double max_range_m = 0.0) {
  return {.type = type,
          .read = read<model>,
          .make_decoder = kOfSettings<make_decoder>,
          .sent_ids = kOfSettings<sent_ids>,
          .label = kOfSettings<label<model>>,
          .describe = kOfSettings<describe<model>>,
          .key = kOfSettings<key>,
          .recognise = sends_like == nullptr ? recognise : nullptr,
          .sends_like = sends_like,
          .max_range_m = max_range_m,
          .obeyed_ids = kOfSettings<obeyed_ids>,
          .rotation_lead_s = kOfSettings<rotation_lead_s>,
          .azimuth_sign_key = kInvertAzimuth};
}

constexpr RadarFamily kArs408 = row<Ars408Model::ars408_21>("ars408");
constexpr RadarFamily kArs404 = row<Ars408Model::ars404_21>("ars404", &kArs408, kArs404MaxRangeM);

}  // namespace

const RadarFamily& family_of(const Ars408Options& options) {
  return options.model == Ars408Model::ars404_21 ? kArs404 : kArs408;
}

}  // namespace cremed
