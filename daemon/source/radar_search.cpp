// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/source/radar_search.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "daemon/configuration/interfaces.hpp"

namespace cremed {
namespace {

/// More than one second, the longest period of a radar's messages.
constexpr std::int64_t kRoundUs = 1'300'000;
/// The kernel's default buffer holds 278 frames, more than arrive in this time.
constexpr std::int64_t kListenPeriodUs = 20'000;
/// The rest stays queued; a bus cannot refill its buffer while it is emptied.
constexpr int kMaxBatches = 100;
/// More than any vehicle has.
constexpr std::size_t kMaxListeners = 64;

}  // namespace

RadarSearch::RadarSearch(const Configuration& configuration)
    : configuration_(configuration), is_over_(has_interface_names(configuration)) {}

std::vector<RadarPlace> RadarSearch::listen(const LinkWatch& links, std::int64_t monotonic_us) {
  if (monotonic_us < next_listen_us_) {
    return {};
  }
  next_listen_us_ = monotonic_us + kListenPeriodUs;
  receive_all();
  if (monotonic_us < round_end_us_) {
    return {};
  }
  const bool is_first = round_end_us_ == 0;
  std::vector<RadarPlace> places = is_first ? std::vector<RadarPlace>() : end_round();
  round_end_us_ = monotonic_us + kRoundUs;
  if (!is_over_) {
    follow(links);
  }
  return places;
}

/// Opens sockets on interfaces that came up since the last round; others have closed themselves.
void RadarSearch::follow(const LinkWatch& links) {
  for (const std::string& name : links.can_names()) {
    const Link link = links.link(name);
    const bool is_heard = std::ranges::count(listeners_, link.index, &Listener::index) != 0;
    if (!link.is_up || is_heard || listeners_.size() >= kMaxListeners) {
      continue;
    }
    auto socket = std::make_unique<CanSocket>();
    if (socket->open(link.index, {}, configuration_.live.socket).error == 0) {
      listeners_.push_back({link.index, std::move(socket)});
      buses_.emplace_back().interface = name;
    }
  }
}

void RadarSearch::receive_all() {
  for (std::size_t listener = listeners_.size(); listener-- > 0;) {
    if (!receive(listener)) {
      listeners_.erase(listeners_.begin() + static_cast<std::ptrdiff_t>(listener));
      buses_.erase(buses_.begin() + static_cast<std::ptrdiff_t>(listener));
    }
  }
}

/// false: the interface went down or was removed.
bool RadarSearch::receive(std::size_t listener) {
  for (int batch = 0; batch < kMaxBatches; ++batch) {
    const CanReceiveResult result = listeners_[listener].socket->receive();
    for (const ReceivedFrame& received : result.frames) {
      buses_[listener].traffic.add(received.frame);
    }
    if (result.frames.empty()) {
      return result.error == 0;
    }
  }
  return true;
}

std::vector<RadarPlace> RadarSearch::end_round() {
  std::vector<RadarPlace> places = find_interfaces(buses_, configuration_);
  for (HeardBus& bus : buses_) {
    bus.traffic = {};
  }
  is_over_ = has_interface_names(configuration_);
  if (is_over_) {
    listeners_.clear();
  }
  return places;
}

}  // namespace cremed
