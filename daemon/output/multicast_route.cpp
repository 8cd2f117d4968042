// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/output/multicast_route.hpp"

#include <cerrno>
#include <cstring>
#include <string_view>

#include <arpa/inet.h>
#include <sys/socket.h>

#include "daemon/process/descriptor.hpp"
#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

constexpr std::string_view kScheme = "udpm://";
constexpr const char* kDefaultGroup = "239.255.76.67";
constexpr std::uint16_t kDefaultPort = 7667;

}  // namespace

std::string multicast_problem(const std::string& url) {
  if (!url.starts_with(kScheme)) {
    return {};
  }
  const std::string named =
      url.substr(kScheme.size(), url.find_first_of(":?", kScheme.size()) - kScheme.size());
  const std::string group = named.empty() ? kDefaultGroup : named;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(kDefaultPort);
  ::inet_pton(AF_INET, group.c_str(), &address.sin_addr);  // is_lcm_url() has checked it.
  // Looks up the route without sending.
  const Descriptor descriptor(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (!descriptor.is_open()) {
    return std::strerror(errno);
  }
  const auto* const generic = reinterpret_cast<const sockaddr*>(&address);
  return ::connect(descriptor.number(), generic, sizeof(address)) == 0
             ? std::string()
             : concat({std::strerror(errno), ". Give multicast a route, e.g. `ip route add ", group,
                       "/32 dev lo`, or use --lcm-url none"});
}

std::string lcm_create_problem(int error) {
  // It goes on without the descriptor that it did not get.
  if (error == EMFILE || error == EBADF) {
    return std::strerror(EMFILE);
  }
  return error == ENFILE || error == ENOMEM || error == ENOBUFS
             ? std::strerror(error)
             : "cannot be set up. A URL is like udpm://239.255.76.67:7667?ttl=0";
}

}  // namespace cremed
