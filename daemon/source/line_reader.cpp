// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/source/line_reader.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/process/plain_text.hpp"
#include "daemon/process/signals.hpp"

namespace cremed {
namespace {

constexpr std::size_t kBeginBytes = 256;

}  // namespace

LineReader::LineReader(const std::string& path)
    : descriptor_(path == "-"
                      ? ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1)
                      : ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)) {
  if (!descriptor_.is_open()) {
    throw std::runtime_error("cannot read " + path + ": " + std::strerror(errno));
  }
  struct stat status {};
  if (::fstat(descriptor_.number(), &status) == 0 && S_ISREG(status.st_mode)) {
    file_bytes_ = static_cast<std::uint64_t>(status.st_size);
  }
}

std::string LineReader::begin() const {
  std::string text(kBeginBytes, '\0');
  const off_t now = ::lseek(descriptor_.number(), 0, SEEK_CUR);
  const ssize_t count = now < 0 ? 0 : ::pread(descriptor_.number(), text.data(), text.size(), now);
  text.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return std::string(without_byte_order_mark(text));
}

LineReader::Status LineReader::next(std::string_view& line) {
  while (true) {
    const char* const first = buffer_.data() + begin_;
    const char* const last = buffer_.data() + end_;
    const void* const found = std::memchr(first, '\n', end_ - begin_);
    const char* const feed = found == nullptr ? last : static_cast<const char*>(found);
    is_unfinished_ = feed == last && at_end_ && (first != last || skipping_);
    if (feed != last || is_unfinished_) {
      begin_ += static_cast<std::size_t>(feed - first) + (is_unfinished_ ? 0U : 1U);
      ++line_number_;
      line = {first, static_cast<std::size_t>(feed - first)};
      line = line_number_ == 1 ? without_byte_order_mark(line) : line;
      const bool was_skipping = skipping_;
      skipping_ = false;
      return was_skipping ? Status::too_long : Status::line;
    }
    if (at_end_) {
      return Status::end;
    }
    const Status status = fill();
    if (status != Status::line) {
      return status;
    }
  }
}

/// Makes room and reads once.
LineReader::Status LineReader::fill() {
  std::copy(buffer_.data() + begin_, buffer_.data() + end_, buffer_.data());
  end_ -= begin_;
  begin_ = 0;
  if (end_ == buffer_.size()) {
    skipping_ = true;
    end_ = 0;
    return Status::interrupted;  // The line may never end.
  }
  pollfd input{descriptor_.number(), POLLIN, 0};
  if (::poll(&input, 1, kStopPollMs) <= 0) {
    return Status::interrupted;
  }
  const ssize_t count = ::read(descriptor_.number(), buffer_.data() + end_, buffer_.size() - end_);
  if (count < 0) {
    return errno == EINTR || errno == EAGAIN ? Status::interrupted : Status::failed;
  }
  at_end_ = count == 0;
  end_ += static_cast<std::size_t>(count);
  read_bytes_ += static_cast<std::uint64_t>(count);
  return Status::line;
}

}  // namespace cremed
