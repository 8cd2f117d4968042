// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "daemon/configuration/radar_place.hpp"
#include "daemon/source/can_socket.hpp"
#include "daemon/source/link_watch.hpp"

namespace cremed {

/// Finds the interfaces of radars with interface = "auto": listens on all CAN interfaces that are
/// up, in rounds long enough to see every message of a radar. Sends nothing and never blocks. Not
/// for the hot path.
class RadarSearch {
 public:
  explicit RadarSearch(const Configuration& configuration);

  /// Call about fifty times a second. At the end of a round: the place of each radar still searched
  /// for; otherwise empty. A found radar is not searched for again.
  std::vector<RadarPlace> listen(const LinkWatch& links, std::int64_t monotonic_us);

  /// All radars are found.
  [[nodiscard]] bool is_over() const { return is_over_; }

  /// The configuration with the interfaces found.
  [[nodiscard]] const Configuration& configuration() const { return configuration_; }

 private:
  struct Listener {
    unsigned index;
    std::unique_ptr<CanSocket> socket;
  };
  void follow(const LinkWatch& links);
  void receive_all();
  bool receive(std::size_t listener);
  std::vector<RadarPlace> end_round();

  Configuration configuration_;
  bool is_over_;
  std::vector<Listener> listeners_;
  std::vector<HeardBus> buses_;  // In the order of listening.
  std::int64_t next_listen_us_ = 0;
  std::int64_t round_end_us_ = 0;
};

}  // namespace cremed
