// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/process/instance_lock.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string_view>

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/process/environment.hpp"

namespace cremed {
namespace {

/// RuntimeDirectory= of the unit, and of whoever is root without it.
constexpr const char* kSystemFolder = "/run/cremed";

/// systemd's, else one that only this user can write; empty: there is none.
std::string runtime_folder() {
  const std::string_view given = environment("RUNTIME_DIRECTORY");
  if (!given.empty()) {
    return std::string(given.substr(0, given.find(':')));
  }
  if (::geteuid() == 0) {
    ::mkdir(kSystemFolder, 0755);
    return kSystemFolder;
  }
  if (::access(kSystemFolder, F_OK) == 0 || errno == EACCES) {
    spdlog::warn(
        "only root sees whether the service runs with this configuration too "
        "(`systemctl status cremed`)");
  }
  return std::string(environment("XDG_RUNTIME_DIR"));
}

/// The path of the configuration, however it is written, as a file name. One too long for that is
/// cut at its beginning.
std::string lock_name(const std::string& path) {
  constexpr std::size_t kLongest = 200;
  struct stat network {};
  ::stat("/proc/self/ns/net", &network);
  std::string name;
  for (const char c : std::filesystem::weakly_canonical(path).string()) {
    name += c == '/' ? "%2F" : c == '%' ? "%25" : std::string(1, c);
  }
  name.erase(0, name.size() - std::min(name.size(), kLongest));
  return std::to_string(network.st_ino) + name + ".lock";
}

}  // namespace

InstanceLock::InstanceLock(const std::string& configuration_path) {
  const std::string folder = runtime_folder();
  const std::string file = folder + "/" + lock_name(configuration_path);
  descriptor_ = Descriptor(
      folder.empty() ? -1 : ::open(file.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600));
  if (!descriptor_.is_open()) {
    spdlog::warn(
        "another instance would not be noticed: {}",
        folder.empty() ? "XDG_RUNTIME_DIR is not set" : file + ": " + std::strerror(errno));
    return;
  }
  if (::flock(descriptor_.number(), LOCK_EX | LOCK_NB) == 0) {
    return;
  }
  throw std::runtime_error(
      "another cremed runs with " + configuration_path +
      " (`pgrep -a cremed`): every message would be sent twice; end that one "
      "(`systemctl stop cremed`), or give this one a configuration of its own");
}

}  // namespace cremed
