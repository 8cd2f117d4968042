// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/report/log_sink.hpp"

#include <algorithm>
#include <climits>

#include <fcntl.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/process/environment.hpp"
#include "daemon/process/plain_text.hpp"
#include "daemon/process/signals.hpp"

namespace cremed {
namespace {

struct LevelText {
  std::string_view name;
  std::string_view colour;
  std::string_view priority;
};

LevelText text_of(spdlog::level::level_enum level) {
  switch (level) {
    case spdlog::level::critical:
    case spdlog::level::err:
      return {"error", "\033[31m\033[1m", "<3>"};
    case spdlog::level::warn:
      return {"warning", "\033[33m\033[1m", "<4>"};
    case spdlog::level::info:
      return {"info", "\033[32m", "<6>"};
    default:
      return {"debug", "\033[36m", "<7>"};
  }
}

/// systemd names the stream it connected; a redirected stream is another.
bool is_journal(const struct stat& status) {
  return fmt::format("{}:{}", status.st_dev, status.st_ino) == environment("JOURNAL_STREAM");
}

}  // namespace

LogSink::LogSink() {
  struct stat status {};
  if (::fstat(STDERR_FILENO, &status) == 0) {
    is_journal_ = is_journal(status);
    is_socket_ = S_ISSOCK(status.st_mode);
    is_shared_ = S_ISFIFO(status.st_mode) || S_ISCHR(status.st_mode);
  }
  is_terminal_ = ::isatty(STDERR_FILENO) == 1;
}

void LogSink::drop_when_full() {
  drops_ = true;
  if (is_journal_) {  // No other process shares this connection.
    ::fcntl(STDERR_FILENO, F_SETFL, ::fcntl(STDERR_FILENO, F_GETFL) | O_NONBLOCK);
  } else if (is_shared_) {
    // Opened anew, O_NONBLOCK affects this process only. If that is not allowed, poll() must
    // suffice.
    const int own = ::open("/proc/self/fd/2", O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (own >= 0) {
      ::dup2(own, STDERR_FILENO);
      ::close(own);
    }
  }
}

void LogSink::log(const spdlog::details::log_msg& message) {
  if (lost_ != 0 && has_room()) {
    const std::string text = fmt::format("log lines dropped: {}", lost_);
    lost_ = 0;
    log_text(spdlog::level::warn, text);
  }
  log_text(message.level, {message.payload.data(), message.payload.size()});
}

/// Writes line by line: the journal takes each as a message.
void LogSink::log_text(spdlog::level::level_enum level, std::string_view text) {
  const LevelText words = text_of(level);
  std::string begin = is_terminal_ ? fmt::format("{}{}\033[m: ", words.colour, words.name)
                                   : fmt::format("{}: ", words.name);
  while (true) {
    const std::size_t size = std::min(text.find('\n'), text.size());
    if (!put(fmt::format("{}{}{}\n", is_journal_ ? words.priority : "", begin,
                         plain_text(text.substr(0, size))))) {
      ++lost_;
    }
    if (size == text.size()) {
      return;
    }
    text.remove_prefix(size + 1);
    begin.clear();
  }
}

bool LogSink::put(std::string line) {
  if (drops_ && line.size() > PIPE_BUF) {
    // A longer line may not fit although poll() reports room.
    line.replace(PIPE_BUF - 1, std::string::npos, "\n");
  }
  if (!has_room()) {
    return false;
  }
  const ssize_t written =
      is_socket_ ? ::send(STDERR_FILENO, line.data(), line.size(), drops_ ? MSG_DONTWAIT : 0)
                 : ::write(STDERR_FILENO, line.data(), line.size());
  return written == static_cast<ssize_t>(line.size());
}

bool LogSink::has_room() const {
  pollfd output{STDERR_FILENO, POLLOUT, 0};
  return drops_ ? ::poll(&output, 1, 0) == 1 : wait_for_room(STDERR_FILENO);
}

std::shared_ptr<LogSink> log_to_standard_error() {
  auto sink = std::make_shared<LogSink>();
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("cremed", sink));
  return sink;
}

}  // namespace cremed
