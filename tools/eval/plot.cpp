// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/plot.hpp"

#include <array>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace cremed {
namespace {

/// Beside an installed cremed-eval, or in the source tree that it was built from.
std::filesystem::path script_path() {
  const auto program = std::filesystem::read_symlink("/proc/self/exe");
  auto installed = program.parent_path().parent_path() / "share/cremed/plot_drive";
  return std::filesystem::exists(installed) ? installed : std::filesystem::path(CREMED_PLOT_SCRIPT);
}

}  // namespace

void plot_drive(const std::string& odometry, const std::string& truth, const std::string& picture) {
  std::string script = script_path();
  std::array<std::string, 3> values{odometry, truth, picture};
  std::array<char*, 5> arguments{script.data(), values[0].data(), values[1].data(),
                                 values[2].data(), nullptr};
  pid_t child = 0;
  const int error =
      ::posix_spawn(&child, script.c_str(), nullptr, nullptr, arguments.data(), environ);
  if (error != 0) {
    throw std::runtime_error("cannot run " + script + ": " + std::strerror(error));
  }
  int status = 0;
  if (::waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw std::runtime_error(script + " could not draw " + picture);
  }
}

}  // namespace cremed
