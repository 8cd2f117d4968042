// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <optional>
#include <span>

#include "cremed/can_decoders/ars408_messages.hpp"
#include "daemon/configuration/configuration.hpp"
#include "daemon/source/can_socket.hpp"
#include "tools/doctor/ars408_search.hpp"

namespace cremed {

/// The user's consent to send. It is read from a terminal only: a pipe, file or bus on standard
/// input is no consent.
struct Consent {
  bool is_given = false;  ///< On the command line: do not ask.
  int terminal = 0;       ///< Descriptor to ask on.
};

/// Asks unless consent was given. Without a terminal, prints the option to give instead.
bool asks_consent(const Consent& consent, std::ostream& out);

/// How to find the sensor, and how long to wait.
struct Ars408TalkOptions {
  Ars408Address address{};
  Consent consent{};
  /// A sensor reports once a second; a second one with its id perhaps every 5 s only.
  std::int64_t listen_us = 6'200'000;
  std::int64_t confirm_us = 3'000'000;
};

/// A dialogue with the sensor of one configured radar, shown to the user.
struct Ars408Talk {
  const Configuration& configuration;
  const RadarConfiguration& radar;
  const Ars408TalkOptions& options;
  CanSocket& socket;
  std::ostream& out;
};

enum class TalkResult : std::uint8_t {
  took,       ///< The sensor confirms everything.
  not_sent,   ///< Not found, or no consent.
  not_taken,  ///< Sent, but the sensor does not confirm all of it.
};

struct MetArs408 {
  std::uint8_t sensor_id;
  Ars408RadarState state;
};

/// Listens, and prints the sensor found or why there is none.
std::optional<MetArs408> meet(const Ars408Talk& talk);

/// Shows the frames to send, and asks for consent.
bool is_agreed(const Ars408Talk& talk, std::span<const CanFrame> frames);

/// Sends the frame once; prints why if that fails. What is received next came after it.
bool send(const Ars408Talk& talk, const CanFrame& frame);

/// Calls `use(frame)` for each frame within the time, until it returns true.
void listen(CanSocket& socket, std::int64_t duration_us,
            const std::function<bool(const CanFrame&)>& use);

}  // namespace cremed
