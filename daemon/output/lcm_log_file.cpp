// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/output/lcm_log_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include <stdio_ext.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/process/clocks.hpp"
#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

/// Of an event in LCM's format: sync word (4), number (8), time (8), two lengths (4 each). Counted,
/// since ftell() is a system call for each message.
constexpr std::size_t kHeaderBytes = 28;
/// More than the longest message: that of a scan has 8 kB.
constexpr std::size_t kLogBufferBytes = std::size_t{1} << 16U;

/// Opening one waits for its reader.
bool is_pipe(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 && S_ISFIFO(status.st_mode);
}

}  // namespace

LcmLogFile::LcmLogFile(std::string path)
    : path_(std::move(path)),
      buffer_(kLogBufferBytes),
      log_(is_pipe(path_) ? nullptr : lcm_eventlog_create(path_.c_str(), "w")) {
  if (is_open()) {
    std::setvbuf(log_->f, buffer_.data(), _IOFBF, buffer_.size());
  }
}

bool LcmLogFile::write(const char* channel, std::span<std::uint8_t> data) {
  if (log_ == nullptr || error_ != 0) {
    return false;
  }
  std::string name(channel);
  lcm_eventlog_event_t event{};
  event.timestamp = realtime_us();
  event.channel = name.data();
  event.channellen = static_cast<std::int32_t>(name.size());
  event.data = data.data();
  event.datalen = static_cast<std::int32_t>(data.size());
  const std::size_t bytes = kHeaderBytes + name.size() + data.size();
  if (unwritten_bytes_ + bytes > kLogBufferBytes && !flush()) {
    return false;
  }
  unwritten_bytes_ += bytes;
  lcm_eventlog_write_event(log_.get(), &event);
  return true;
}

bool LcmLogFile::flush() {
  if (log_ == nullptr || error_ != 0) {
    return false;
  }
  errno = 0;
  if (std::fflush(log_->f) == 0 && std::ferror(log_->f) == 0) {
    size_bytes_ += static_cast<std::int64_t>(std::exchange(unwritten_bytes_, 0));
    written_ = log_->eventcount;
    return true;
  }
  error_ = errno != 0 ? errno : EIO;
  lost_ = static_cast<std::uint64_t>(log_->eventcount - written_);
  __fpurge(log_->f);  // Closing does not try again.
  [[maybe_unused]] const int of_a_device = ::ftruncate(::fileno(log_->f), size_bytes_);
  return false;
}

std::string LcmLogFile::problem() const {
  return error_ == 0 ? std::string()
                     : concat({path_, ": message ", std::to_string(written_ + 1),
                               " could not be written: ", std::strerror(error_),
                               "; the file ends with the one before"});
}

}  // namespace cremed
