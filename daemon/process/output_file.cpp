// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/process/output_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <stdexcept>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/process/message_text.hpp"
#include "daemon/process/signals.hpp"

namespace cremed {
namespace {

int opened(const std::string& path) {
  return path == "-"
             ? ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1)
             : ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOCTTY, 0644);
}

bool is_regular_file(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
}

std::uint64_t count_lines(std::string_view text) {
  return static_cast<std::uint64_t>(std::ranges::count(text, '\n'));
}

}  // namespace

OutputFile::OutputFile(const std::string& path)
    : path_(path == "-" ? "standard output" : path), descriptor_(opened(path)) {
  if (!descriptor_.is_open()) {
    throw std::runtime_error(concat({"cannot write ", path_, ": ", std::strerror(errno)}));
  }
  is_regular_ = is_regular_file(descriptor_.number());
}

void OutputFile::write(std::string_view lines) {
  if (failures_ != 0) {
    ++failures_;
    return;
  }
  // Prevents a signal from ending the process within a line.
  std::optional<SignalsBlocked> blocked;
  if (is_regular_) {
    blocked.emplace();
  }
  std::size_t done = 0;
  while (done < lines.size()) {
    const long count = write_some(lines.substr(done));
    if (count <= 0) {
      return fail(lines.substr(0, done));
    }
    done += static_cast<std::size_t>(count);
  }
  lines_ += count_lines(lines);
}

long OutputFile::write_some(std::string_view text) const {
  errno = 0;
  if (!is_regular_ && !wait_for_room(descriptor_.number())) {
    return -1;
  }
  return ::write(descriptor_.number(), text.data(), text.size());
}

/// Removes an incomplete last line.
void OutputFile::fail(std::string_view written) {
  error_ = errno;
  ++failures_;
  lines_ += count_lines(written);
  const std::size_t last_feed = written.rfind('\n');
  const std::size_t begun =
      last_feed == std::string_view::npos ? written.size() : written.size() - last_feed - 1;
  if (is_regular_ && begun != 0) {
    const off_t end = ::lseek(descriptor_.number(), 0, SEEK_CUR) - static_cast<off_t>(begun);
    if (::ftruncate(descriptor_.number(), end) == 0) {
      ::lseek(descriptor_.number(), end, SEEK_SET);
    }
  }
}

std::string OutputFile::problem() const {
  if (failures_ == 0) {
    return {};
  }
  const std::string line = std::to_string(lines_ + 1);
  return concat({path_, ": line ", line, " could not be written: ", std::strerror(error_),
                 is_regular_ ? "; the file ends with the line before" : ""});
}

}  // namespace cremed
