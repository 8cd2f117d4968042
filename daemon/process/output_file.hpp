// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "daemon/process/descriptor.hpp"

namespace cremed {

/// A text file that always ends on a complete line, also on a full disk or when a signal ends the
/// process. Unbuffered.
class OutputFile {
 public:
  /// Creates or truncates the file; "-" is standard output. Throws std::runtime_error with path and
  /// reason.
  explicit OutputFile(const std::string& path);

  /// Writes complete lines, or counts a failure. Nothing is written after the first failure. Waits
  /// for the reader of a full pipe until a stop is requested (signals.hpp).
  void write(std::string_view lines);

  /// Calls of write() that failed.
  [[nodiscard]] std::uint64_t failures() const { return failures_; }
  /// The line that could not be written, and why; empty if none.
  [[nodiscard]] std::string problem() const;

 private:
  long write_some(std::string_view text) const;
  void fail(std::string_view written);

  std::string path_;
  Descriptor descriptor_;
  bool is_regular_ = false;
  std::uint64_t lines_ = 0;
  int error_ = 0;
  std::uint64_t failures_ = 0;
};

}  // namespace cremed
