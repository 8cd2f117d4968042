// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/report/service_notifier.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <spdlog/fmt/fmt.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "daemon/process/clocks.hpp"
#include "daemon/process/environment.hpp"
#include "daemon/process/whole_number.hpp"

namespace cremed {
namespace {

/// systemd ignores longer messages; 16 radars need 2000.
constexpr std::size_t kMaxMessage = 4096;

/// A path, or with a leading '@' a name in the abstract namespace.
Descriptor connected_socket(std::string_view name) {
  sockaddr_un address{};
  if (name.size() < 2 || name.size() >= sizeof(address.sun_path) ||
      (name[0] != '/' && name[0] != '@')) {
    return Descriptor();
  }
  address.sun_family = AF_UNIX;
  std::copy(name.begin(), name.end(), address.sun_path);
  if (name[0] == '@') {
    address.sun_path[0] = '\0';
  }
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
  Descriptor descriptor(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const bool is_connected =
      ::connect(descriptor.number(), reinterpret_cast<const sockaddr*>(&address), size) == 0;
  return is_connected ? std::move(descriptor) : Descriptor();
}

}  // namespace

ServiceNotifier::ServiceNotifier() : descriptor_(connected_socket(environment("NOTIFY_SOCKET"))) {
  const std::string_view watched = environment("WATCHDOG_PID");
  if (watched.empty() || whole_number<std::int64_t>(watched) == ::getpid()) {
    watchdog_period_us_ = whole_number<std::int64_t>(environment("WATCHDOG_USEC")).value_or(0) / 2;
  }
}

void ServiceNotifier::reloading() const {
  send(fmt::format("RELOADING=1\nMONOTONIC_USEC={}", monotonic_us()));
}

void ServiceNotifier::status(std::string_view text) const {
  send(fmt::format("STATUS={}", text).substr(0, kMaxMessage));
}

void ServiceNotifier::send(std::string_view message) const {
  if (descriptor_.is_open()) {
    // What the manager does not accept in time is in the next message.
    [[maybe_unused]] const ssize_t sent =
        ::send(descriptor_.number(), message.data(), message.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  }
}

}  // namespace cremed
