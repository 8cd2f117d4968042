// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/process/process_setup.hpp"

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <string>
#include <string_view>

#include <ext/stdio_sync_filebuf.h>
#include <fcntl.h>
#include <unistd.h>

#include "daemon/process/descriptor.hpp"
#include "daemon/process/plain_text.hpp"

namespace cremed {
namespace {

/// Text for a descriptor.
struct PlainOutput {
  int descriptor;
  std::string unfinished;  ///< An incomplete UTF-8 sequence.
};

/// For fopencookie(3): 0 is an error.
ssize_t write_plain(void* cookie, const char* data, std::size_t size) {
  auto& output = *static_cast<PlainOutput*>(cookie);
  std::string text = output.unfinished.append(data, size);
  const std::size_t whole = text.size() - unfinished_bytes(text);
  output.unfinished = text.substr(whole);
  text.resize(whole);
  return write_all(output.descriptor, plain_text(text)) ? static_cast<ssize_t>(size) : 0;
}

std::FILE* open_plain(PlainOutput& output, int buffering, std::ostream& stream) {
  std::FILE* const file = ::fopencookie(&output, "w", {nullptr, write_plain, nullptr, nullptr});
  if (file != nullptr) {
    std::setvbuf(file, nullptr, buffering, BUFSIZ);
    stream.rdbuf(new __gnu_cxx::stdio_sync_filebuf<char>(file));  // As std::cout has for stdout.
  }
  return file;
}

/// Passes all output of std::cout, std::cerr, stdout and stderr through plain_text(), because
/// programs print what they read. To be called before anything is printed.
void make_standard_streams_plain() {
  // Never destroyed: standard streams are flushed after all other objects.
  static auto& output = *new PlainOutput{STDOUT_FILENO, {}};
  static auto& errors = *new PlainOutput{STDERR_FILENO, {}};
  std::cout.flush();
  std::fflush(stdout);
  const int buffering = ::isatty(STDOUT_FILENO) == 1 ? _IOLBF : _IOFBF;
  if (std::FILE* const file = open_plain(output, buffering, std::cout)) {
    stdout = file;
  }
  if (std::FILE* const file = open_plain(errors, _IONBF, std::cerr)) {
    stderr = file;
  }
}

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
