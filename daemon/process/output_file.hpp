// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace cremed {

/// A text file that ends on a whole line at any time, also on a full disk and where a signal ends
/// the process. Nothing waits in a buffer.
class OutputFile {
 public:
  /// Creates or empties the file; "-" is standard output. Throws std::runtime_error with path and
  /// reason.
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Writes whole lines, or counts a failure. After the first one nothing more is written. A pipe
  /// that nobody reads is waited for until a stop is requested (signals.hpp).
  void write(std::string_view lines);

  /// Calls of write() that did not write all of it.
  [[nodiscard]] std::uint64_t failures() const { return failures_; }
  /// Which line could not be written, and why; empty if all were.
  [[nodiscard]] std::string problem() const;

 private:
  long write_some(std::string_view text) const;
  void fail(std::string_view written);

  std::string path_;
  int descriptor_;
  bool is_regular_ = false;
  std::uint64_t lines_ = 0;
  int error_ = 0;
  std::uint64_t failures_ = 0;
};

}  // namespace cremed
