// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/unpacked_file.hpp"

#include <array>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace cremed {
namespace {

/// Runs `xz -dc` with the output into a file; 0, or what is wrong.
int unpack(std::string packed, const std::string& output) {
  std::string program = "xz";
  std::string option = "-dc";
  const std::array<char*, 4> arguments{program.data(), option.data(), packed.data(), nullptr};
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT,
                                     0600);
  pid_t child = 0;
  const int error =
      ::posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (error != 0 || ::waitpid(child, &status, 0) != child) {
    return error != 0 ? error : errno;
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? 0 : EIO;
}

}  // namespace

std::string unpacked_file(const std::string& path, const TemporaryFolder& folder) {
  const std::string packed = path + ".xz";
  if (std::filesystem::exists(path) || !std::filesystem::exists(packed)) {
    return path;
  }
  std::string result = folder.file(std::filesystem::path(path).filename());
  if (const int error = unpack(packed, result); error != 0) {
    throw std::runtime_error("cannot unpack " + packed + " with xz: " + std::strerror(error));
  }
  return result;
}

}  // namespace cremed
