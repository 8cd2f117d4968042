// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <catch2/catch.hpp>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "daemon/process/instance_lock.hpp"
#include "daemon/process/usage_error.hpp"

using namespace cremed;

namespace {

/// The runtime directory of the service manager.
class RuntimeFolder {
 public:
  RuntimeFolder() : path_("/tmp/cremed-test-lock-" + std::to_string(::getpid())) {
    std::filesystem::create_directory(path_);
    ::setenv("RUNTIME_DIRECTORY", path_.c_str(), 1);
  }
  ~RuntimeFolder() {
    ::unsetenv("RUNTIME_DIRECTORY");
    std::filesystem::remove_all(path_);
  }
  RuntimeFolder(const RuntimeFolder&) = delete;
  RuntimeFolder& operator=(const RuntimeFolder&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace

TEST_CASE("A configuration is locked once, however its path is written, until the lock ends") {
  const RuntimeFolder folder;
  const std::string path = folder.path() + "/cremed.toml";
  {
    const InstanceLock lock(path);
    CHECK_THROWS_WITH(InstanceLock(folder.path() + "/./x/../cremed.toml"),
                      Catch::Contains("another cremed runs with"));
    CHECK_NOTHROW(InstanceLock(folder.path() + "/other.toml"));
    CHECK_NOTHROW(InstanceLock(folder.path() + "%2Fcremed.toml"));
  }
  CHECK_NOTHROW(InstanceLock(path));
}

TEST_CASE("A second instance is no bad usage: that would keep the service from starting again") {
  const RuntimeFolder folder;
  const InstanceLock lock("/etc/cremed/cremed.toml");
  try {
    const InstanceLock second("/etc/cremed/cremed.toml");
    FAIL("locked twice");
  } catch (const UsageError&) {
    FAIL("exit status 2");
  } catch (const std::runtime_error&) {
    SUCCEED();
  }
}

TEST_CASE("Nobody else can open the file, or hold the lock by a name") {
  const RuntimeFolder folder;
  const std::string path = "/tmp/cremed-test-" + std::to_string(::getpid()) + ".toml";
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = "cremed:" + path;
  name.copy(&address.sun_path[1], sizeof(address.sun_path) - 1);
  const int other = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  REQUIRE(::bind(other, reinterpret_cast<const sockaddr*>(&address),
                 static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size())) == 0);
  const InstanceLock lock(path);
  ::close(other);
  for (const auto& file : std::filesystem::directory_iterator(folder.path())) {
    struct stat status {};
    REQUIRE(::stat(file.path().c_str(), &status) == 0);
    CHECK((status.st_mode & 0777) == 0600);
  }
}

TEST_CASE("A long path, a link in place of the file and a folder that is gone stop nothing") {
  const RuntimeFolder folder;
  const std::string path = "/" + std::string(200, 'a') + "/" + std::string(200, 'b') + ".toml";
  {
    const InstanceLock lock(path);
    CHECK_THROWS_AS(InstanceLock(path), std::runtime_error);
  }
  std::filesystem::path file = std::filesystem::directory_iterator(folder.path())->path();
  const std::string target = folder.path() + "/target";
  std::filesystem::remove(file);
  std::filesystem::create_symlink(target, file);
  CHECK_NOTHROW(InstanceLock(path));
  CHECK_FALSE(std::filesystem::exists(target));
  std::filesystem::remove_all(folder.path());
  CHECK_NOTHROW(InstanceLock(path));
}
