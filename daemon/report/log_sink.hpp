// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include <spdlog/sinks/sink.h>

namespace cremed {

/// Standard error as the log of one thread, "warning: text" per line. For the journal a line begins
/// with its priority ("<4>", sd-daemon(3)); on a terminal the level is coloured.
class LogSink final : public spdlog::sinks::sink {
 public:
  LogSink();

  /// By default a line waits for room in a pipe, socket or terminal until a stop is requested
  /// (signals.hpp). After this call it is dropped instead, and the number of dropped lines is
  /// logged when there is room again. Output of libraries does not block either.
  void drop_when_full();

  void log(const spdlog::details::log_msg& message) override;
  void flush() override {}  // Unbuffered.
  void set_pattern(const std::string& /*pattern*/) override {}
  void set_formatter(std::unique_ptr<spdlog::formatter> /*formatter*/) override {}

 private:
  void log_text(spdlog::level::level_enum level, std::string_view text);
  bool put(std::string line);
  [[nodiscard]] bool has_room() const;

  bool is_journal_ = false;
  bool is_terminal_ = false;
  bool is_socket_ = false;
  bool is_shared_ = false;  // A pipe or terminal shared with other processes.
  bool drops_ = false;
  std::uint64_t lost_ = 0;
};

/// Makes a LogSink the only sink of spdlog.
std::shared_ptr<LogSink> log_to_standard_error();

}  // namespace cremed
