// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/plot.hpp"

#include <csignal>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/process/replaced_file.hpp"
#include "tools/eval/input_file.hpp"
#include "tools/eval/temporary_folder.hpp"

namespace cremed {
namespace {

/// As installed, and in a build.
std::filesystem::path script_path(const std::string& script) {
  const auto program = std::filesystem::read_symlink("/proc/self/exe");
  auto path = program.parent_path().parent_path() / "share/cremed" / script;
  if (!std::filesystem::exists(path)) {
    throw std::runtime_error(
        "what draws pictures is not installed: "
        "apt-get install cremed-laboratory");
  }
  return path;
}

/// Holds SIGINT back, of which Python would tell with a traceback while it starts; plotting.py
/// releases it.
int start_script(const std::vector<char*>& arguments, pid_t& child) {
  sigset_t held_back;
  ::sigemptyset(&held_back);
  ::sigaddset(&held_back, SIGINT);
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  ::posix_spawnattr_setsigmask(&attributes, &held_back);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  const int error =
      ::posix_spawn(&child, arguments[0], nullptr, &attributes, arguments.data(), environ);
  ::posix_spawnattr_destroy(&attributes);
  return error;
}

/// Runs a plot script; throws if it fails.
void run_script(std::vector<std::string> command, const std::string& picture) {
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (std::string& argument : command) {
    arguments.push_back(argument.data());
  }
  arguments.push_back(nullptr);
  pid_t child = 0;
  if (const int error = start_script(arguments, child); error != 0) {
    throw std::runtime_error("cannot run " + command[0] + ": " + std::strerror(error));
  }
  int status = 0;
  if (::waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw std::runtime_error(command[0] + " could not draw " + picture);
  }
}

}  // namespace

std::string picture_problem(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension();
  for (const char* known : {".png", ".svg", ".pdf", ".jpg"}) {
    if (extension == known) {
      return {};
    }
  }
  return "a picture's name ends with .png, .svg, .pdf or .jpg, not like '" + path + "'";
}

void draw_plot(const std::string& script, const std::vector<std::string>& inputs,
               const std::string& picture) {
  const TemporaryFolder folder;
  const std::string drawn = folder.file(std::filesystem::path(picture).filename());
  std::vector<std::string> command{script_path(script)};
  command.insert(command.end(), inputs.begin(), inputs.end());
  command.push_back(drawn);
  run_script(std::move(command), picture);
  replace_file(picture, with_input(drawn, content));
}

}  // namespace cremed
