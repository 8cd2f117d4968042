// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/process/instance_lock.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>

#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "daemon/process/usage_error.hpp"

namespace cremed {
namespace {

constexpr std::string_view kPrefix = "cremed:";

/// Independent of how the path is written; `ss -xl` shows it as "@cremed:/etc/...". A path too long
/// for a socket name is cut at its beginning.
std::string lock_name(const std::string& path) {
  constexpr std::size_t kLongestPath = sizeof(sockaddr_un::sun_path) - 1 - kPrefix.size();
  const std::string whole = std::filesystem::weakly_canonical(path).string();
  return std::string(kPrefix) + whole.substr(whole.size() - std::min(whole.size(), kLongestPath));
}

/// In the abstract namespace: after a zero.
int bind_name(int descriptor, const std::string& name) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::copy(name.begin(), name.end(), &address.sun_path[1]);
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  return ::bind(descriptor, reinterpret_cast<const sockaddr*>(&address), size);
}

}  // namespace

InstanceLock::InstanceLock(const std::string& configuration_path)
    : descriptor_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  if (descriptor_ >= 0 && bind_name(descriptor_, lock_name(configuration_path)) == 0) {
    return;
  }
  const int error = errno;
  if (error != EADDRINUSE) {
    spdlog::warn("another instance would not be noticed: {}", std::strerror(error));
    return;
  }
  ::close(descriptor_);
  throw UsageError("another cremed runs with " + configuration_path +
                   " (`pgrep -a cremed`): every message would be sent twice; end that one "
                   "(`systemctl stop cremed`), or give this one a configuration of its own");
}

InstanceLock::~InstanceLock() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

}  // namespace cremed
