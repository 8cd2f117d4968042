// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "daemon/process/descriptor.hpp"

namespace cremed {

/// Reads a file or standard input line by line through a fixed buffer, without delay: follows the
/// pipe of a live candump.
class LineReader {
 public:
  enum class Status : std::uint8_t {
    line,         ///< `line` is set, valid until the next call.
    too_long,     ///< A line longer than the buffer was skipped.
    end,          ///< End of input.
    interrupted,  ///< A signal, a pause, or a line in progress; call again.
    failed,       ///< read(2) failed; errno says why.
  };

  /// "-" is standard input. next() waits for the writer of a pipe. Throws std::runtime_error with
  /// path and reason.
  explicit LineReader(const std::string& path);

  /// The next line without its line feed.
  Status next(std::string_view& line);
  /// The first bytes of a file, before anything is read; empty for a pipe.
  [[nodiscard]] std::string begin() const;
  /// Number of the last line returned, from 1.
  [[nodiscard]] std::uint64_t line_number() const { return line_number_; }
  /// Whether that line has no line feed: the input ends within it.
  [[nodiscard]] bool is_unfinished() const { return is_unfinished_; }
  /// Size of a file at its opening; 0: unknown, a pipe.
  [[nodiscard]] std::uint64_t file_bytes() const { return file_bytes_; }
  [[nodiscard]] std::uint64_t read_bytes() const { return read_bytes_; }

 private:
  Status fill();

  Descriptor descriptor_;
  std::array<char, 65536> buffer_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  bool skipping_ = false;  // inside a line that is too long
  bool at_end_ = false;
  bool is_unfinished_ = false;
  std::uint64_t line_number_ = 0;
  std::uint64_t file_bytes_ = 0;
  std::uint64_t read_bytes_ = 0;
};

}  // namespace cremed
