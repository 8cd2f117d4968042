// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace cremed {

/// Reads a file or standard input line by line through a fixed buffer. Hands out what has arrived:
/// a pipe from a live candump is followed without delay.
class LineReader {
 public:
  enum class Status : std::uint8_t {
    line,         ///< `line` is set, valid until the next call.
    too_long,     ///< A line longer than the buffer was passed over.
    end,          ///< End of input.
    interrupted,  ///< A signal came, or nothing for a while, or still the same line; call again.
    failed,       ///< read(2) failed; errno says why.
  };

  /// "-" is standard input. A pipe that nobody writes to yet is waited for in next(). Throws
  /// std::runtime_error with path and reason.
  explicit LineReader(const std::string& path);
  ~LineReader();
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  /// The next line without its line feed.
  Status next(std::string_view& line);
  /// What a file begins with, before anything is read of it; nothing of a pipe.
  [[nodiscard]] std::string begin() const;
  /// Number of the line last returned, from 1.
  [[nodiscard]] std::uint64_t line_number() const { return line_number_; }

 private:
  Status fill();

  int descriptor_;
  std::array<char, 65536> buffer_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  bool skipping_ = false;  // inside a line that is too long
  bool at_end_ = false;
  std::uint64_t line_number_ = 0;
};

}  // namespace cremed
