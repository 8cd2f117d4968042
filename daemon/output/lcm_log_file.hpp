// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <lcm/lcm.h>

namespace cremed {

/// An LCM log that always ends on a complete message, also on a full disk. LCM's own
/// file://PATH?mode=w does not report lost messages.
class LcmLogFile {
 public:
  /// Creates or truncates the file, which must not be a pipe; is_open() tells whether that
  /// succeeded.
  explicit LcmLogFile(std::string path);
  LcmLogFile(const LcmLogFile&) = delete;
  LcmLogFile& operator=(const LcmLogFile&) = delete;
  ~LcmLogFile() { flush(); }

  [[nodiscard]] bool is_open() const { return log_ != nullptr; }
  /// False if the message is lost. Messages are written many at once: one each took 7 % of a
  /// replay's time.
  bool write(const char* channel, std::span<std::uint8_t> data);
  /// False if not all are written. Then nothing more is written.
  bool flush();
  /// Messages that write() took and that could not be written then.
  [[nodiscard]] std::uint64_t lost() const { return lost_; }
  /// The message that could not be written, and why; empty if none.
  [[nodiscard]] std::string problem() const;

 private:
  struct Close {
    void operator()(lcm_eventlog_t* log) const { lcm_eventlog_destroy(log); }
  };
  std::string path_;
  std::vector<char> buffer_;  // Until log_ is closed.
  std::unique_ptr<lcm_eventlog_t, Close> log_;
  std::int64_t size_bytes_ = 0;  // Of the messages in the file.
  std::size_t unwritten_bytes_ = 0;
  std::int64_t written_ = 0;  // Messages.
  std::uint64_t lost_ = 0;
  int error_ = 0;
};

}  // namespace cremed
