// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/live_observation.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <linux/can.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>

#include "daemon/configuration/interfaces.hpp"
#include "daemon/process/clocks.hpp"
#include "daemon/process/descriptor.hpp"
#include "daemon/radar_channel.hpp"
#include "daemon/source/link_watch.hpp"
#include "tools/doctor/observer.hpp"

namespace cremed {
namespace {

constexpr int kPollMs = 100;

/// An observed interface.
struct Ear {
  std::string interface;
  std::unique_ptr<CanSocket> socket;
};

std::set<std::string> interfaces_to_hear(const Configuration& configuration) {
  const std::vector<std::string> there = LinkWatch().can_names();
  const std::vector<std::string> wanted = interface_names(configuration);
  std::set<std::string> names(there.begin(), there.end());
  names.insert(wanted.begin(), wanted.end());
  return names;
}

std::vector<Ear> open_all(const Configuration& configuration, Observer& observer) {
  std::vector<Ear> ears;
  for (const std::string& name : interfaces_to_hear(configuration)) {
    if (auto socket = open_bus(configuration.live.socket, observer.bus(name))) {
      ears.push_back({name, std::move(socket)});
    }
  }
  return ears;
}

/// Reads the available frames; false if the interface was removed.
bool receive(const Ear& ear, Observer& observer) {
  const CanReceiveResult result = ear.socket->receive();
  for (const ReceivedFrame& received : result.frames) {
    if (received.lost_before != 0) {
      observer.add_lost(ear.interface, received.lost_before);
    }
    observer.add(ear.interface, received.frame);
  }
  return result.error == 0;
}

void listen(std::vector<Ear>& ears, std::int64_t deadline_us,
            const volatile std::sig_atomic_t* stop, Observer& observer) {
  std::vector<pollfd> polled(ears.size());
  while (!ears.empty() && *stop == 0 && monotonic_us() < deadline_us) {
    std::transform(ears.begin(), ears.end(), polled.begin(), [](const Ear& ear) {
      return pollfd{ear.socket->descriptor(), POLLIN, 0};
    });
    ::poll(polled.data(), polled.size(), kPollMs);
    observer.note_time(realtime_us());
    for (std::size_t i = 0; i < polled.size(); ++i) {
      if (polled[i].revents != 0 && !receive(ears[i], observer)) {
        ears[i].socket->close();  // poll() ignores a negative descriptor.
      }
    }
  }
}

}  // namespace

bool kernel_has_can() {
  const Descriptor socket(::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW));
  return socket.is_open() || (errno != EAFNOSUPPORT && errno != EPROTONOSUPPORT);
}

InterfaceState state_of(const std::string& interface) {
  const Link link = LinkWatch().link(interface);
  if (link.index == 0) {
    return InterfaceState::absent;
  }
  if (!link.is_can) {
    return InterfaceState::not_can;
  }
  if (!link.is_up) {
    return InterfaceState::down;
  }
  return link.has_carrier ? InterfaceState::up : InterfaceState::bus_off;
}

std::unique_ptr<CanSocket> open_bus(const CanSocketOptions& options, BusObservation& bus) {
  bus.state = state_of(bus.interface);
  if (bus.state != InterfaceState::up && bus.state != InterfaceState::bus_off) {
    return nullptr;
  }
  auto socket = std::make_unique<CanSocket>();
  const CanOpenResult result = socket->open(::if_nametoindex(bus.interface.c_str()), {}, options);
  if (result.error != 0) {
    bus.state = InterfaceState::failed;
    bus.error = std::strerror(result.error);
    return nullptr;
  }
  bus.status.receive_buffer_bytes = result.receive_buffer_bytes;
  return socket;
}

Observation observe_live(const Configuration& configuration, double seconds,
                         const volatile std::sig_atomic_t* stop) {
  Observer observer(configuration);
  const bool has_can = kernel_has_can();
  const std::int64_t begin_us = monotonic_us();
  if (has_can) {
    std::vector<Ear> ears = open_all(configuration, observer);
    observer.note_time(realtime_us());
    listen(ears, begin_us + std::llround(seconds * 1e6), stop, observer);
    for (const Ear& ear : ears) {
      observer.bus(ear.interface).state = state_of(ear.interface);  // Its final state.
    }
  }
  Observation observation = observer.finish();
  observation.is_live = true;
  observation.kernel_has_can = has_can;
  observation.seconds = static_cast<double>(monotonic_us() - begin_us) * 1e-6;
  return observation;
}

}  // namespace cremed
