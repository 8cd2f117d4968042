// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/source/radar_search.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "daemon/configuration/interfaces.hpp"

namespace cremed {
namespace {

/// More than the second after which each radar has sent every message once.
constexpr std::int64_t kRoundUs = 1'300'000;
/// Fewer frames come meanwhile than the kernel's default buffer holds, 278.
constexpr std::int64_t kListenPeriodUs = 20'000;
/// What is left waits; a bus cannot refill its buffer while it is emptied.
constexpr int kMaxBatches = 100;
/// A vehicle has fewer.
constexpr std::size_t kMaxEars = 64;

}  // namespace

RadarSearch::RadarSearch(const Configuration& configuration)
    : configuration_(configuration), is_over_(has_interface_names(configuration)) {}

std::vector<Sighting> RadarSearch::listen(const LinkWatch& links, std::int64_t monotonic_us) {
  if (monotonic_us < next_listen_us_) {
    return {};
  }
  next_listen_us_ = monotonic_us + kListenPeriodUs;
  receive_all();
  if (monotonic_us < round_end_us_) {
    return {};
  }
  const bool is_first = round_end_us_ == 0;
  std::vector<Sighting> sightings = is_first ? std::vector<Sighting>() : end_round();
  round_end_us_ = monotonic_us + kRoundUs;
  if (!is_over_) {
    follow(links);
  }
  return sightings;
}

/// Opens sockets on what came up since the round before. One on an interface that went down or away
/// ends by itself.
void RadarSearch::follow(const LinkWatch& links) {
  for (const std::string& name : links.up_can_names()) {
    const unsigned index = links.link(name).index;
    const bool is_heard =
        std::any_of(ears_.begin(), ears_.end(), [&](const Ear& ear) { return ear.index == index; });
    if (is_heard || ears_.size() >= kMaxEars) {
      continue;
    }
    auto socket = std::make_unique<CanSocket>();
    if (socket->open(index, {}, configuration_.live.socket).status == CanOpenStatus::open) {
      ears_.push_back({index, std::move(socket)});
      buses_.emplace_back().interface = name;
    }
  }
}

void RadarSearch::receive_all() {
  for (std::size_t ear = ears_.size(); ear-- > 0;) {
    if (!receive(ear)) {
      ears_.erase(ears_.begin() + static_cast<std::ptrdiff_t>(ear));
      buses_.erase(buses_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
  }
}

/// false: the interface went down or away.
bool RadarSearch::receive(std::size_t ear) {
  for (int batch = 0; batch < kMaxBatches; ++batch) {
    const CanReceiveResult result = ears_[ear].socket->receive();
    for (const ReceivedFrame& received : result.frames) {
      buses_[ear].traffic.add(received.frame);
    }
    if (result.status != CanReceiveStatus::frames) {
      return result.status == CanReceiveStatus::empty;
    }
  }
  return true;
}

std::vector<Sighting> RadarSearch::end_round() {
  std::vector<Sighting> sightings = find_interfaces(buses_, configuration_);
  for (HeardBus& bus : buses_) {
    bus.traffic = {};
  }
  is_over_ = has_interface_names(configuration_);
  if (is_over_) {
    ears_.clear();
  }
  return sightings;
}

}  // namespace cremed
