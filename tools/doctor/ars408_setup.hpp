// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>

#include "daemon/can_socket.hpp"
#include "daemon/configuration.hpp"

namespace cremed {

struct Ars408Setup {
  std::optional<double> max_distance_m{};  ///< As it is, if not set.
  bool store = false;                      ///< To flash.
  bool is_agreed = false;                  ///< Do not ask.
  std::int64_t listen_us = 2'200'000;      ///< A sensor reports once a second.
  std::int64_t confirm_us = 3'000'000;
};

enum class SetupResult : std::uint8_t {
  took,       ///< The sensor confirms every setting.
  not_sent,   ///< Not found, or the user did not agree.
  not_taken,  ///< Sent, but the sensor does not confirm all of it.
};

/// Sets an ARS408 to what the configuration expects of it: output, quality, no extended messages,
/// sensor id; the range, if asked for. Shows what it reads and would send, asks, sends once, and
/// says of each setting whether the sensor's next 0x201 confirms it.
SetupResult set_up_ars408(const Configuration& configuration, const RadarConfiguration& radar,
                          const Ars408Setup& setup, CanSocket& socket, std::istream& answers,
                          std::ostream& out);

}  // namespace cremed
