// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>
#include <string_view>

#include "daemon/configuration/configuration_radar.hpp"
#include "daemon/configuration/configuration_sections.hpp"
#include "daemon/configuration/interfaces.hpp"
#include "daemon/configuration/radar_identifiers.hpp"
#include "daemon/process/message_text.hpp"
#include "daemon/process/whole_number.hpp"

namespace cremed {
namespace {

constexpr std::string_view kOff = "off";
constexpr std::uint32_t kMaxId = 0x7FF;

/// "0x300"
std::optional<std::uint32_t> id_of(std::string_view text) {
  constexpr std::string_view kPrefix = "0x";
  if (!text.starts_with(kPrefix)) {
    return std::nullopt;
  }
  constexpr int kHexadecimal = 16;
  const auto id = whole_number<std::uint32_t>(text.substr(kPrefix.size()), kHexadecimal);
  return id && *id <= kMaxId ? id : std::nullopt;
}

constexpr TextRule kBusName = {
    [](std::string_view text) { return is_interface_name(text) && text != kAutoInterface; },
    "the name of a CAN interface, not \"auto\", or \"off\""};
constexpr TextRule kIdentifier = {
    [](std::string_view text) { return text == kOff || id_of(text).has_value(); },
    "a CAN identifier in quotes, \"0x0\" to \"0x7FF\", or \"off\""};

void read_id(TomlReader& reader, std::string_view key, std::optional<std::uint32_t>& id) {
  std::string text = id ? hexadecimal(*id) : std::string(kOff);
  reader.text(key, text, kIdentifier);
  id = id_of(text);
}

void check_id(TomlReader& reader, std::string_view key, std::optional<std::uint32_t> id,
              const Configuration& configuration) {
  for (const RadarConfiguration& radar : configuration.radars) {
    if (id && radar.interface == configuration.vehicle.interface && radar.decoder.sent_ids()[*id]) {
      reader.report(key, concat({"is ", hexadecimal(*id), ", which radar ", in_quotes(radar.name),
                                 " sends on that interface; must be another identifier"}));
    }
  }
}

}  // namespace

void read_vehicle(TomlReader& reader, VehicleConfiguration& vehicle, VehicleOptions& options) {
  constexpr Range kDelayS{0.0, 0.2};
  constexpr Range kScale{0.0, 0.5};
  std::string interface(kOff);
  reader.text("interface", interface, kBusName);
  vehicle.interface = interface == kOff ? "" : interface;
  read_id(reader, "speed", vehicle.ids[static_cast<std::size_t>(VehicleSignal::speed)]);
  read_id(reader, "yaw_rate", vehicle.ids[static_cast<std::size_t>(VehicleSignal::yaw_rate)]);
  reader.number("speed_delay_s", options.speed.delay_s, kDelayS);
  reader.number("speed_scale_std", options.speed.scale_std, kScale);
  reader.number("yaw_rate_delay_s", options.yaw_rate.delay_s, kDelayS);
  reader.number("yaw_rate_scale_std", options.yaw_rate.scale_std, kScale);
  reader.number("yaw_rate_bias_std_radps", options.yaw_rate_bias_std_radps, {0.0, 1.0});
  reader.finish();
  options.speed.is_used = vehicle.is_used(VehicleSignal::speed);
  options.yaw_rate.is_used = vehicle.is_used(VehicleSignal::yaw_rate);
}

void check_vehicle(TomlReader& reader, const Configuration& configuration) {
  const VehicleConfiguration& vehicle = configuration.vehicle;
  if (vehicle.interface.empty()) {
    return;
  }
  const auto speed = vehicle.id(VehicleSignal::speed);
  const auto yaw_rate = vehicle.id(VehicleSignal::yaw_rate);
  if (!configuration.odometry.enabled) {
    reader.report("interface", "is to be heard, but odometry.enabled = false; must be \"off\"");
  }
  if (!speed && !yaw_rate) {
    reader.report("interface", "has neither speed nor yaw_rate; must be \"off\"");
  }
  if (speed && speed == yaw_rate) {
    reader.report("yaw_rate", "is the identifier of speed as well; must be another");
  }
  check_id(reader, "speed", speed, configuration);
  check_id(reader, "yaw_rate", yaw_rate, configuration);
  const auto& radars = configuration.radars;
  const auto told = std::ranges::find_if(radars, has_motion_feedback);
  if (told != radars.end()) {
    reader.report(
        "interface",
        concat({"is to be heard, but cremed itself sends speed and yaw rate to radar ",
                in_quotes(told->name),
                " (motion_feedback), and would believe its own estimate; must be \"off\", "
                "or motion_feedback = false"}));
  }
}

}  // namespace cremed
