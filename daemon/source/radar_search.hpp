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

/// Finds the interfaces of the radars that are configured without (interface = "auto"): listens on
/// all CAN interfaces that are up, in rounds as long as it takes to see all that a radar sends.
/// Sends nothing and never waits. Not for the hot path, but for beside it.
class RadarSearch {
 public:
  explicit RadarSearch(const Configuration& configuration);

  /// To be called some fifty times a second. At the end of a round: of each radar that is looked
  /// for, where it is; a radar that was found is looked for no more. Empty meanwhile.
  std::vector<Sighting> listen(const LinkWatch& links, std::int64_t monotonic_us);

  /// All are found.
  [[nodiscard]] bool is_over() const { return is_over_; }

  /// With the interfaces that were found.
  [[nodiscard]] const Configuration& configuration() const { return configuration_; }

 private:
  struct Ear {
    unsigned index;
    std::unique_ptr<CanSocket> socket;
  };
  void follow(const LinkWatch& links);
  void receive_all();
  bool receive(std::size_t ear);
  std::vector<Sighting> end_round();

  Configuration configuration_;
  bool is_over_;
  std::vector<Ear> ears_;
  std::vector<HeardBus> buses_;  // By ear.
  std::int64_t next_listen_us_ = 0;
  std::int64_t round_end_us_ = 0;
};

}  // namespace cremed
