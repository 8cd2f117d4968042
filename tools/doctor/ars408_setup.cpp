// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/ars408_setup.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <istream>
#include <ostream>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <poll.h>

#include "can_decoders/ars408_commands.hpp"
#include "daemon/candump.hpp"
#include "daemon/clocks.hpp"
#include "daemon/message_text.hpp"
#include "tools/doctor/ars408_search.hpp"

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
  for (const Setting& setting : settings) {
    if (setting.text(state) != setting.text(wanted)) {
      return false;
    }
  }
  return true;
}

/// As candump shows it: "can0 200#3800000010040000".
std::string frame_text(const std::string& interface, const CanFrame& frame) {
  std::array<char, kMaxCandumpLine> line{};
  const std::string_view text(line.data(), format_candump_line(frame, interface, line));
  const std::size_t begin = text.find(' ') + 1;
  return std::string(text.substr(begin, text.find('\n') - begin));
}

/// Calls `use(frame)` for each frame that comes in time, until it returns true.
template <typename Use>
void listen(CanSocket& socket, std::int64_t duration_us, Use use) {
  constexpr int kPollMs = 50;
  const std::int64_t end_us = monotonic_us() + duration_us;
  while (monotonic_us() < end_us) {
    pollfd polled{socket.descriptor(), POLLIN, 0};
    ::poll(&polled, 1, kPollMs);
    const CanReceiveResult result = socket.receive();
    for (const ReceivedFrame& received : result.frames) {
      if (use(received.frame)) {
        return;
      }
    }
    if (result.status != CanReceiveStatus::frames && result.status != CanReceiveStatus::empty) {
      return;
    }
  }
}

bool asks_yes(const Ars408Setup& setup, std::istream& answers, std::ostream& out) {
  if (setup.is_agreed) {
    return true;
  }
  out << "Send it? [y/N] " << std::flush;
  std::string answer;
  std::getline(answers, answer);
  return answer == "y" || answer == "Y" || answer == "yes";
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

/// What the sensor says after the command, under its new id or, if it kept it, its old one.
std::optional<Ars408RadarState> confirmed_state(CanSocket& socket, std::uint8_t old_id,
                                                const std::vector<Setting>& settings,
                                                const Ars408RadarState& wanted,
                                                std::int64_t duration_us) {
  Ars408States states;
  listen(socket, duration_us, [&](const CanFrame& frame) {
    note_state(frame, states);
    const auto& state = states[wanted.sensor_id];
    return state && is_as_wanted(settings, wanted, *state);
  });
  return states[wanted.sensor_id] ? states[wanted.sensor_id] : states[old_id];
}

SetupResult show_result(const std::vector<Setting>& settings, const Ars408RadarState& wanted,
                        const std::optional<Ars408RadarState>& state, std::ostream& out) {
  if (!state) {
    out << "no 0x201 came after it: the sensor does not confirm anything\n";
    return SetupResult::not_taken;
  }
  for (const Setting& setting : settings) {
    const std::string now = setting.text(*state);
    const bool took = now == setting.text(wanted);
    out << "  " << setting.name << ": " << now
        << (took ? ", took\n" : ", did not take: wanted " + setting.text(wanted) + '\n');
  }
  return is_as_wanted(settings, wanted, *state) ? SetupResult::took : SetupResult::not_taken;
}

}  // namespace

SetupResult set_up_ars408(const Configuration& configuration, const RadarConfiguration& radar,
                          const Ars408Setup& setup, CanSocket& socket, std::istream& answers,
                          std::ostream& out) {
  BusObservation bus;
  Ars408States states;
  listen(socket, setup.listen_us, [&](const CanFrame& frame) {
    bus.add(frame);
    note_state(frame, states);
    return false;
  });
  const Ars408Search found = find_ars408(configuration, radar, bus, states);
  if (!found.sensor_id) {
    out << found.problem << "; nothing was sent\n";
    return SetupResult::not_sent;
  }
  const Ars408RadarState now = *states[*found.sensor_id];
  const Ars408RadarState wanted = wanted_state(std::get<Ars408Options>(radar.decoder), setup, now);
  const std::vector<Setting> settings = settings_of(setup);
  const CanFrame frame = encode_ars408_command(*found.sensor_id, command_for(wanted, setup));
  out << radar.name << ": ARS408 with sensor id " << unsigned{*found.sensor_id} << " on "
      << radar.interface << '\n';
  if (!setup.store && is_as_wanted(settings, wanted, now)) {
    out << "It is set so already; nothing was sent.\n";
    return SetupResult::took;
  }
  show_plan(settings, now, wanted, setup, out);
  out << frame_text(radar.interface, frame) << '\n';
  if (!asks_yes(setup, answers, out)) {
    out << "nothing was sent\n";
    return SetupResult::not_sent;
  }
  if (const int error = socket.send(frame); error != 0) {
    out << radar.interface << ": " << std::strerror(error) << "; it was not sent\n";
    return SetupResult::not_sent;
  }
  return show_result(settings, wanted,
                     confirmed_state(socket, *found.sensor_id, settings, wanted, setup.confirm_us),
                     out);
}

}  // namespace cremed
