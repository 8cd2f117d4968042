// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/ars408_talk.hpp"

#include <cstring>
#include <memory>
#include <ostream>
#include <string>

#include <poll.h>
#include <unistd.h>

#include "daemon/process/clocks.hpp"
#include "daemon/source/candump.hpp"

namespace cremed {
namespace {

/// A line, and the status if it is incomplete.
std::string read_line(int descriptor) {
  constexpr std::size_t kLongest = 80;
  std::string line;
  char c = '\0';
  while (line.size() < kLongest && ::read(descriptor, &c, 1) == 1 && c != '\n') {
    line += c;
  }
  return line;
}

/// In the format of candump: "can0 200#3800000010040000".
std::string frame_text(const std::string& interface, const CanFrame& frame) {
  const std::string line = candump_line(frame, interface);
  const std::size_t begin = line.find(' ') + 1;
  return line.substr(begin, line.find('\n') - begin);
}

/// Discards what came before, such as while the user was asked: it is no answer.
void drain(CanSocket& socket) {
  constexpr int kMostBatches = 1000;  // More than a receive buffer holds.
  for (int i = 0; i < kMostBatches && !socket.receive().frames.empty(); ++i) {
  }
}

}  // namespace

bool asks_consent(const Consent& consent, std::ostream& out) {
  if (consent.is_given) {
    return true;
  }
  if (::isatty(consent.terminal) == 0) {
    out << "standard input is no terminal; add --yes to give consent\n";
    return false;
  }
  out << "Send it? [y/N] " << std::flush;
  const std::string answer = read_line(consent.terminal);
  return answer == "y" || answer == "Y" || answer == "yes";
}

void listen(CanSocket& socket, std::int64_t duration_us,
            const std::function<bool(const CanFrame&)>& use) {
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
    if (result.error != 0) {
      return;
    }
  }
}

std::optional<MetArs408> meet(const Ars408Talk& talk) {
  const auto bus = std::make_unique<BusObservation>();
  Ars408States states;
  listen(talk.socket, talk.options.listen_us, [&](const CanFrame& frame) {
    bus->add(frame);
    note_state(frame, states);
    return false;
  });
  const Ars408Search found =
      find_ars408(talk.configuration, talk.radar, talk.options.address, *bus, states);
  if (!found.sensor_id) {
    talk.out << found.problem << "; nothing was sent\n";
    return std::nullopt;
  }
  talk.out << talk.radar.name << ": ARS408 with sensor id " << unsigned{*found.sensor_id} << " on "
           << talk.radar.interface << '\n';
  return MetArs408{*found.sensor_id, *states[*found.sensor_id].state};
}

bool is_agreed(const Ars408Talk& talk, std::span<const CanFrame> frames) {
  for (const CanFrame& frame : frames) {
    talk.out << frame_text(talk.radar.interface, frame) << '\n';
  }
  const bool is_agreed = asks_consent(talk.options.consent, talk.out);
  talk.out << (is_agreed ? "" : "nothing was sent\n");
  return is_agreed;
}

bool send(const Ars408Talk& talk, const CanFrame& frame) {
  drain(talk.socket);
  const int error = talk.socket.send(frame);
  if (error != 0) {
    talk.out << frame_text(talk.radar.interface, frame) << " was not sent: " << std::strerror(error)
             << '\n';
  }
  return error == 0;
}

}  // namespace cremed
