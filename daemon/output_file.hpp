// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace cremed {

/// A text file written a line at a time, each with one write(2): nothing waits in a buffer.
class OutputFile {
 public:
  /// Creates or empties the file; throws std::runtime_error with path and reason.
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Writes all of it, or counts a failure.
  void write(std::string_view text);

  [[nodiscard]] std::uint64_t failures() const { return failures_; }

 private:
  int descriptor_;
  std::uint64_t failures_ = 0;
};

}  // namespace cremed
