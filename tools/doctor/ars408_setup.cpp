// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/ars408_setup.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cremed/can_decoders/ars408_commands.hpp"
#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

constexpr std::uint8_t kObjects = 1;
constexpr std::uint8_t kClusters = 2;

/// One setting of the sensor, as text.
struct Setting {
  std::string_view name;
  std::string (*text)(const Ars408RadarState& state);
};

std::string on_off(bool on) { return on ? "on" : "off"; }

std::string output_text(const Ars408RadarState& state) {
  constexpr std::array<std::string_view, 4> kNames{"nothing", "objects", "clusters", "reserved"};
  return std::string(kNames[state.output_code & 3U]);
}

constexpr Setting kOutput{"output", output_text};
constexpr Setting kQuality{
    "quality", [](const Ars408RadarState& state) { return on_off(state.sends_quality); }};
constexpr Setting kExtended{
    "extended", [](const Ars408RadarState& state) { return on_off(state.sends_extended); }};
constexpr Setting kSensorId{
    "sensor id", [](const Ars408RadarState& state) { return std::to_string(state.sensor_id); }};
constexpr Setting kMaxDistance{
    "range", [](const Ars408RadarState& state) { return digits(state.max_distance_m) + " m"; }};
constexpr Setting kStored{"stored", [](const Ars408RadarState& state) {
                            return std::string(state.nvm_written ? "yes" : "no");
                          }};

std::vector<Setting> settings_of(const Ars408Setup& setup) {
  std::vector<Setting> settings{kOutput, kQuality, kExtended, kSensorId};
  if (setup.max_distance_m) {
    settings.push_back(kMaxDistance);
  }
  if (setup.store) {
    settings.push_back(kStored);
  }
  return settings;
}

Ars408RadarState wanted_state(const Ars408Options& options, const Ars408Setup& setup,
                              Ars408RadarState state) {
  constexpr double kStepM = 2.0;
  state.output_code = options.output == Ars408Output::clusters ? kClusters : kObjects;
  state.sends_quality = true;
  state.sends_extended = false;
  state.sensor_id = options.sensor_id;
  if (setup.max_distance_m) {
    state.max_distance_m = std::round(*setup.max_distance_m / kStepM) * kStepM;
  }
  state.nvm_written = state.nvm_written || setup.store;
  return state;
}

Ars408Command command_for(const Ars408RadarState& wanted, const Ars408Setup& setup) {
  Ars408Command command;
  command.max_distance_m = setup.max_distance_m;
  command.sensor_id = wanted.sensor_id;
  command.output_code = wanted.output_code;
  command.sends_quality = wanted.sends_quality;
  command.sends_extended = wanted.sends_extended;
  if (setup.store) {
    command.store = true;
  }
  return command;
}

bool is_as_wanted(const std::vector<Setting>& settings, const Ars408RadarState& wanted,
                  const Ars408RadarState& state) {
  return std::ranges::all_of(settings, [&](const Setting& setting) {
    return setting.text(state) == setting.text(wanted);
  });
}

void show_plan(const std::vector<Setting>& settings, const Ars408RadarState& now,
               const Ars408RadarState& wanted, const Ars408Setup& setup, std::ostream& out) {
  for (const Setting& setting : settings) {
    out << "  " << setting.name << ": " << setting.text(now) << " -> " << setting.text(wanted)
        << '\n';
  }
  out << (setup.store ? "It will be written to the sensor's flash, which wears: do this once, not "
                        "at every start.\n"
                      : "It lasts until the sensor's power is switched off; --store keeps it.\n");
}

/// The sensor's state after the command, under its new or its old id.
std::optional<Ars408RadarState> confirmed_state(const Ars408Talk& talk, std::uint8_t old_id,
                                                const std::vector<Setting>& settings,
                                                const Ars408RadarState& wanted) {
  Ars408States states;
  listen(talk.socket, talk.options.confirm_us, [&](const CanFrame& frame) {
    note_state(frame, states);
    const auto& state = states[wanted.sensor_id].state;
    return state && is_as_wanted(settings, wanted, *state);
  });
  const auto& state = states[wanted.sensor_id].state;
  return state ? state : states[old_id].state;
}

TalkResult show_result(const std::vector<Setting>& settings, const Ars408RadarState& wanted,
                       const std::optional<Ars408RadarState>& state, std::ostream& out) {
  if (!state) {
    out << "no 0x201 came after it: the sensor confirms nothing\n";
    return TalkResult::not_taken;
  }
  for (const Setting& setting : settings) {
    const std::string now = setting.text(*state);
    const bool took = now == setting.text(wanted);
    out << "  " << setting.name << ": " << now
        << (took ? ", set\n" : ", not set: expected " + setting.text(wanted) + '\n');
  }
  return is_as_wanted(settings, wanted, *state) ? TalkResult::took : TalkResult::not_taken;
}

}  // namespace

TalkResult set_up_ars408(const Ars408Talk& talk, const Ars408Setup& setup) {
  const auto met = meet(talk);
  if (!met) {
    return TalkResult::not_sent;
  }
  const Ars408RadarState wanted =
      wanted_state(*talk.radar.decoder.as<Ars408Options>(), setup, met->state);
  const std::vector<Setting> settings = settings_of(setup);
  // Flash that holds them is not written again.
  if (is_as_wanted(settings, wanted, met->state)) {
    talk.out << "It already has these settings" << (setup.store ? ", in its flash too" : "")
             << "; nothing was sent.\n";
    return TalkResult::took;
  }
  show_plan(settings, met->state, wanted, setup, talk.out);
  const CanFrame frame = encode_ars408_command(met->sensor_id, command_for(wanted, setup));
  if (!is_agreed(talk, std::span(&frame, 1)) || !send(talk, frame)) {
    return TalkResult::not_sent;
  }
  return show_result(settings, wanted, confirmed_state(talk, met->sensor_id, settings, wanted),
                     talk.out);
}

}  // namespace cremed
