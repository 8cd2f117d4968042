// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include <spdlog/sinks/sink.h>

namespace cremed {

/// Standard error as the log of one thread: "warning: text" a line. Where it is the journal each
/// line begins with its priority ("<4>", sd-daemon(3)), on a terminal the level has its colour.
class LogSink final : public spdlog::sinks::sink {
 public:
  LogSink();

  /// A line for which a pipe, a socket or a terminal has no room is waited with, until a stop is
  /// requested (signals.hpp). From now on it is lost instead; how many were is told when there is
  /// room again. What libraries print does not wait either.
  void drop_when_full();

  void log(const spdlog::details::log_msg& message) override;
  void flush() override {}  // Nothing waits in a buffer.
  void set_pattern(const std::string& /*pattern*/) override {}
  void set_formatter(std::unique_ptr<spdlog::formatter> /*formatter*/) override {}

 private:
  void log_text(spdlog::level::level_enum level, std::string_view text);
  bool put(std::string line);
  [[nodiscard]] bool has_room() const;

  bool is_journal_ = false;
  bool is_terminal_ = false;
  bool is_socket_ = false;
  bool is_shared_ = false;  // A pipe or terminal that others write to as well.
  bool drops_ = false;
  std::uint64_t lost_ = 0;
};

/// Makes a LogSink the sink of all of spdlog.
std::shared_ptr<LogSink> log_to_standard_error();

}  // namespace cremed
