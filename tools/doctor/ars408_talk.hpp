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
#include "tools/doctor/consent.hpp"

namespace cremed {

/// How to find the sensor, and how long to wait for it.
struct Ars408TalkOptions {
  Ars408Address address{};
  Consent consent{};
  std::int64_t listen_us = 2'200'000;  ///< A sensor reports once a second.
  std::int64_t confirm_us = 3'000'000;
};

/// A talk with the sensor that is one radar of the configuration; the user hears it all.
struct Ars408Talk {
  const Configuration& configuration;
  const RadarConfiguration& radar;
  const Ars408TalkOptions& options;
  CanSocket& socket;
  std::ostream& out;
};

enum class TalkResult : std::uint8_t {
  took,       ///< The sensor confirms everything.
  not_sent,   ///< Not found, or the user did not agree.
  not_taken,  ///< Sent, but the sensor does not confirm all of it.
};

struct MetArs408 {
  std::uint8_t sensor_id;
  Ars408RadarState state;
};

/// Listens, and says which sensor it is, or why it is none.
std::optional<MetArs408> meet(const Ars408Talk& talk);

/// Shows the frames that are to be sent, and asks.
bool is_agreed(const Ars408Talk& talk, std::span<const CanFrame> frames);

/// Sends it once; says why, if that cannot be.
bool send(const Ars408Talk& talk, const CanFrame& frame);

/// Calls `use(frame)` for each frame that comes in time, until it returns true.
void listen(CanSocket& socket, std::int64_t duration_us,
            const std::function<bool(const CanFrame&)>& use);

}  // namespace cremed
