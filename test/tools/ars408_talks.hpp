// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Dialogues with ARS408s on a bus in memory.

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include <pty.h>
#include <unistd.h>

#include "test/tools/fake_ars408.hpp"
#include "tools/doctor/ars408_talk.hpp"

namespace cremed::test {

/// "front" with sensor id 0 and "left" with 3, on one bus.
inline Configuration two_ars408s(Ars408Output output = Ars408Output::clusters) {
  Configuration configuration;
  for (const std::uint8_t sensor : {std::uint8_t{0}, std::uint8_t{3}}) {
    RadarConfiguration radar;
    radar.name = sensor == 0 ? "front" : "left";
    radar.interface = "can0";
    radar.decoder = Ars408Options{.sensor_id = sensor, .output = output};
    configuration.radars.push_back(radar);
  }
  return configuration;
}

/// The factory setting: objects, with all their messages.
inline Ars408RadarState factory_state(std::uint8_t sensor_id) {
  Ars408RadarState state = good_state(sensor_id);
  state.output_code = 1;
  state.sends_extended = true;
  return state;
}

/// A standard input for a program.
class Input {
 public:
  enum class Kind : std::uint8_t { terminal, pipe, closed };

  /// Provides `typed`, then the end of the file.
  Input(Kind kind, std::string_view typed) {
    if (kind == Kind::terminal && ::openpty(&other_, &own_, nullptr, nullptr, nullptr) == 0) {
      write(std::string(typed) + '\x04');  // End of file on a terminal.
    } else if (std::array<int, 2> ends{}; kind == Kind::pipe && ::pipe(ends.data()) == 0) {
      std::tie(own_, other_) = std::pair(ends[0], ends[1]);
      write(typed);
      ::close(std::exchange(other_, -1));
    }
  }
  ~Input() {
    ::close(own_);
    ::close(other_);
  }
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  [[nodiscard]] int descriptor() const { return own_; }

 private:
  void write(std::string_view text) const {
    if (::write(other_, text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
      throw std::runtime_error("cannot type");
    }
  }

  int own_ = -1;
  int other_ = -1;
};

/// Waits for sensors that report about a hundred times as often as real ones, so that the period is
/// not checked. The wait for an answer is long, unless there will be none.
inline Ars408TalkOptions quick_talk(const Ars408Manners& manners) {
  const bool answers = manners.obeys && !manners.keeps_range && !manners.falls_silent;
  Ars408TalkOptions options;
  options.address.shortest_three_us = 0;
  options.listen_us = 60'000;
  options.confirm_us = answers ? 20'000'000 : 400'000;
  return options;
}

}  // namespace cremed::test
