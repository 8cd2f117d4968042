// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/process/process_setup.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>

#include <fcntl.h>
#include <unistd.h>

#include "daemon/process/plain_streams.hpp"

namespace cremed {
namespace {

/// open(2) takes the lowest free number; those below are in use.
void open_if_closed(int descriptor, int flags) {
  if (::fcntl(descriptor, F_GETFD) < 0 && ::open("/dev/null", flags) != descriptor) {
    std::_Exit(1);  // No stream is left for a message.
  }
}

}  // namespace

void set_up_process() {
  open_if_closed(STDIN_FILENO, O_RDONLY);
  open_if_closed(STDOUT_FILENO, O_RDONLY);  // Writing results to it then fails.
  open_if_closed(STDERR_FILENO, O_WRONLY);
  std::signal(SIGXFSZ, SIG_IGN);
  make_standard_streams_plain();
}

int finish_process(int status) {
  errno = 0;
  const bool is_good =
      std::cout.flush().good() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (is_good) {
    return status;
  }
  // An earlier failure leaves errno 0.
  std::fprintf(stderr, "standard output could not be written: %s\n",
               errno != 0 ? std::strerror(errno) : "a part is missing");
  return status == 0 ? 1 : status;
}

}  // namespace cremed
