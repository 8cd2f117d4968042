// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/temporary_folder.hpp"

#include <array>
#include <atomic>
#include <climits>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <system_error>

#include <sys/wait.h>
#include <unistd.h>

namespace cremed {
namespace {

constexpr std::array kSignals{SIGHUP, SIGINT, SIGTERM};

/// For the signal handler.
char process_folder_path[PATH_MAX];

/// What a handler may call does not remove a folder: another program does.
void remove_and_die(int number) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::execl("/bin/rm", "rm", "-rf", "--", process_folder_path, nullptr);
    ::_exit(1);
  }
  ::waitpid(child, nullptr, 0);
  ::signal(number, SIG_DFL);
  ::raise(number);
}

/// Holds all temporary folders of this process; removed when it ends, by a signal too.
class ProcessFolder {
 public:
  ProcessFolder() {
    const std::string name = std::filesystem::temp_directory_path() / "cremed-XXXXXX";
    if (name.size() >= sizeof(process_folder_path)) {
      throw std::runtime_error("cannot make the folder " + name);
    }
    name.copy(process_folder_path, name.size());
    // A signal waits until its handler can remove the folder.
    sigset_t signals;
    sigset_t before;
    ::sigemptyset(&signals);
    for (const int number : kSignals) {
      ::sigaddset(&signals, number);
    }
    ::pthread_sigmask(SIG_BLOCK, &signals, &before);
    const bool is_made = make();
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    if (!is_made) {
      throw std::runtime_error("cannot make the folder " + name);
    }
  }
  ~ProcessFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(process_folder_path, ignored);
  }
  ProcessFolder(const ProcessFolder&) = delete;
  ProcessFolder& operator=(const ProcessFolder&) = delete;

  [[nodiscard]] std::filesystem::path next() {
    return std::filesystem::path(process_folder_path) / std::to_string(count_++);
  }

 private:
  static bool make() {
    if (::mkdtemp(process_folder_path) == nullptr) {
      return false;
    }
    for (const int number : kSignals) {
      if (::signal(number, remove_and_die) == SIG_IGN) {
        ::signal(number, SIG_IGN);  // nohup
      }
    }
    return true;
  }

  std::atomic<int> count_{0};
};

}  // namespace

TemporaryFolder::TemporaryFolder() {
  static ProcessFolder process_folder;
  path_ = process_folder.next();
  std::filesystem::create_directory(path_);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace cremed
