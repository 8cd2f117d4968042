// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <lcm/lcm.h>

namespace cremed {

/// An LCM log that ends on a whole message, also on a full disk: LCM's own address
/// file://PATH?mode=w does not tell when one is lost.
class LcmLogFile {
 public:
  /// Creates or empties it; is_open() says whether that could be.
  explicit LcmLogFile(std::string path);

  [[nodiscard]] bool is_open() const { return log_ != nullptr; }
  /// False if it is not all in the file. Then, and ever after, nothing of it is.
  bool write(const char* channel, std::span<std::uint8_t> data);
  /// Which message could not be written, and why; empty if all were.
  [[nodiscard]] std::string problem() const;

 private:
  struct Close {
    void operator()(lcm_eventlog_t* log) const { lcm_eventlog_destroy(log); }
  };
  std::string path_;
  std::unique_ptr<lcm_eventlog_t, Close> log_;
  std::int64_t size_bytes_ = 0;  // Of whole messages.
  int error_ = 0;
};

}  // namespace cremed
