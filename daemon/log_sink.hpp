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
  /// Of a line for which a pipe, a socket or a terminal has no room.
  enum class WhenFull : std::uint8_t {
    wait,  ///< Until there is, or a stop is requested (signals.hpp).
    drop,  ///< At once; how many were lost is told when there is room again.
  };

  LogSink();

  void set_when_full(WhenFull when_full) { when_full_ = when_full; }

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
  WhenFull when_full_ = WhenFull::wait;
  std::uint64_t lost_ = 0;
};

/// Makes a LogSink the sink of all of spdlog.
std::shared_ptr<LogSink> log_to_standard_error();

}  // namespace cremed
